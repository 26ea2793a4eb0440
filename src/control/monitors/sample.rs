//! What the monitors look at.

use crate::control::signals::{Feedback, Report};
use nalgebra::Vector4;

/// What one sample tells.
pub(super) struct Sample<'a> {
    pub feedback: &'a Feedback,
    pub report: &'a Report,
    /// N.
    pub tensions: Vector4<f64>,
    /// Motor travel, r m, cm.
    pub travel: Vector4<f64>,
    /// How far the motors turned since the last sample, rad.
    pub turned: Vector4<f64>,
    /// N at the tendon, of the command that acted.
    pub pulls: Vector4<f64>,
    /// Since the last sample, s.
    pub elapsed: f64,
    /// The gauges' largest count.
    pub full_scale: u16,
}
