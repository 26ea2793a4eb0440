//! Zeroing and identification in closed loop with the simulated finger: what is found, and what is refused.

mod bench;
mod identifying;
mod pose;
mod refusing;
mod signs;
mod zeroing;
