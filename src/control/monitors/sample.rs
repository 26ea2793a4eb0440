//! Input of the monitors.

use crate::control::signals::{Feedback, Report};
use nalgebra::Vector4;

/// The data of one sample.
pub(super) struct Sample<'a> {
    pub feedback: &'a Feedback,
    pub report: &'a Report,
    /// Tensions, N.
    pub tensions: Vector4<f64>,
    /// Travel of the tendons at the motors, which is motor radius times motor angle, cm.
    pub travel: Vector4<f64>,
    /// Angle that the motors have turned since the last sample, rad.
    pub turned: Vector4<f64>,
    /// Pulls at the tendons that the previous cycle commanded, N.
    pub pulls: Vector4<f64>,
    /// Time since the last sample, s.
    pub elapsed: f64,
    /// The largest count of the gauges.
    pub full_scale: u16,
}
