//! Three simulated fingers and one object that all of them touch, with their servos, in memory and in simulated time.

mod holding;
mod rig;
mod shared_cable;
mod slipping;
