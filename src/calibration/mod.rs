//! The routines that find the signs and zeros of a finger, test its wiring, and identify its friction, elasticity,
//! gauge gains, rotor inertia and moment arms. They move the finger and evaluate its response.
//!
//! Each routine is a state machine without side effects: every servo cycle gives it a measurement, and it returns an
//! activity. It has no clock and allocates nothing. Its verdict contains its findings or the reason for a refusal. The
//! hand stores and applies the findings.

mod average;
mod causes;
mod findings;
mod identification;
mod instruments;
mod joint_guide;
mod obstacle;
mod routine;
mod self_test;
mod signs;
mod step;
mod stop_search;
mod take_up;
mod zeroing;

pub use findings::{Findings, Identified, IdentifiedArms, Signs, Tolerances, Zeros};
pub use obstacle::Obstacle;
pub use routine::{Calibration, Task, Verdict};
pub use step::{Progress, Sample, Step};
