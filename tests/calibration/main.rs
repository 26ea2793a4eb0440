//! Zeroing and identification in closed loop with the simulated finger: their findings and their refusals.

mod bench;
mod identifying;
mod pose;
mod refusing;
mod signs;
mod zeroing;
