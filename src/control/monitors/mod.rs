//! Monitors: what is wrong with tendons, gauges, encoders, motors and joints, found from what a cycle has measured and
//! commanded. One file a monitor; each says once what it means by wrong.
//!
//! They watch a finger that is a spring: while slack is taken up, calibrated or let go, all of it is as it should be.

mod agreement;
mod alarm;
mod encoder_jump;
mod gauge_range;
mod gauge_stuck;
mod joint_stop;
mod line_quality;
mod motor_heat;
mod sample;
mod stalled_motor;
mod tension_lost;
mod watch;

pub use alarm::{Alarm, Alarms, Symptom};
pub use line_quality::LineQuality;
pub(crate) use watch::Monitors;
pub use watch::Watch;
