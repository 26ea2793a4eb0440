//! Black box files: a file is written completely or not at all, and no altered file makes a replay panic, hang or
//! exhaust the memory.

mod altered;
mod hostile;
mod recorded;
mod writing;
