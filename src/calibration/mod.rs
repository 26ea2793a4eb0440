//! Zeroing and identification of a finger: routines that move it and learn from what it does.
//!
//! Each is a state machine of the pure core: measurement in, activity out, one step a servo cycle. It knows no clock
//! and allocates nothing. What it found, or why it gave up, is its verdict; storing and applying that is the hand's
//! business.

mod average;
mod balance;
mod encoder_zero;
mod findings;
mod gauge_zero;
mod grip;
mod identification;
mod instruments;
mod joint_friction;
mod joint_lead;
mod least_squares;
mod motor_friction;
mod obstacle;
mod pressing;
mod routine;
mod signs;
mod standstill;
mod step;
mod stop_search;
mod take_up;
mod tendon_stiffness;
mod wiring;
mod zeroing;

pub use findings::{Findings, Identified, Signs, Zeros};
pub use obstacle::Obstacle;
pub use routine::{Calibration, Task, Verdict};
pub use step::{Progress, Sample, Step};
