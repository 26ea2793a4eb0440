//! The monitors detect faults of tendons, gauges, encoders, motors and joints from the measurements and commands of a
//! cycle. Each monitor has a file of its own, which defines how the monitor recognises its faults.
//!
//! The monitors run while a finger follows a set point. Taking up slack, calibration and release can cause the same
//! symptoms without a fault.

mod agreement;
mod alarm;
mod encoder_jump;
mod gauge_ends;
mod gauge_range;
mod gauge_stuck;
mod joint_stop;
mod line_quality;
mod mismatch;
mod motor_heat;
mod sample;
mod stalled_motor;
mod tension_lost;
mod watch;

pub(crate) use agreement::SHARE_OF_FRICTION;
pub use alarm::{Alarm, Alarms, Symptom};
pub use line_quality::LineQuality;
pub(crate) use watch::Monitors;
pub use watch::Watch;
