//! Three simulated fingers grasp one object. Their servos run in simulated time. A cable in memory connects the servos
//! to the simulated board.

mod holding;
mod rig;
mod shared_cable;
mod slipping;
