//! Files of black boxes: a file is written whole or not at all, and no file, however it was altered, makes a replay
//! panic, hang or exhaust the memory.

mod altered;
mod hostile;
mod recorded;
mod writing;
