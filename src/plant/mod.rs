//! The physics of a finger and its sensors: what stands behind the simulated board. SI units inside; every number of
//! the configuration is converted once, at construction.

mod contact;
mod finger_plant;
mod holding_hand;
mod joint_friction;
mod joint_stops;
mod motors;
mod sensors;
mod tendon;

pub use finger_plant::{PLANT_STEP_SECONDS, Plant};
pub use sensors::Sensors;
