//! The physics of a finger and its sensors, which the simulated board uses. The computation is in SI units, and the
//! numbers of the configuration are converted once, at construction. Exception: the link lengths and a fixed surface
//! stay in cm, as in the configuration. So the position of the tip is in cm, and its velocity in cm/s.

mod amplifier;
mod capstan;
mod contact;
mod elasticity;
mod finger_plant;
mod friction_contact;
mod gauge_filter;
mod holding_hand;
mod joint_friction;
mod joint_stops;
mod motors;
mod object;
mod object_shape;
mod sensors;
mod stribeck;
mod tendon;

pub use finger_plant::{PLANT_STEP_SECONDS, Plant};
pub use object::{FreeObject, TipMotion};
pub use sensors::Sensors;
