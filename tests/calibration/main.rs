//! Runs the calibration routines in closed loop with the simulated finger. Checks their findings and their refusals.

mod bench;
mod exactness;
mod identifying;
mod inertia;
mod pose;
mod refusing;
mod rubbing;
mod self_test;
mod signs;
mod zeroing;
