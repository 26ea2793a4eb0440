//! What the configuration says about the motion of a finger's set points.

use crate::control::motion::Interpolation;
use crate::finger::Validity;
use crate::model::configuration::{ConfiguredFinger, ExpiryReaction};
use nalgebra::Matrix3;
use std::time::Duration;

/// What a servo does with the set points of its planner.
#[derive(Clone, Debug)]
pub struct MotionSettings {
    /// The interpolation of set points, if they are interpolated.
    pub interpolation: Option<Interpolation>,
    /// How long a set point is valid, s; none if it never expires.
    pub valid: Option<f64>,
    /// How long a finger holds its pose after its set point has expired, until it faults, s; none if there is no time
    /// limit.
    pub end_state: Option<f64>,
    /// The reaction to a set point that has expired.
    pub after_expiry: AfterExpiry,
}

/// The reaction to a set point that has expired.
#[derive(Clone, Copy, Debug)]
pub enum AfterExpiry {
    /// The finger holds its present pose with this Kx, N/cm.
    Hold(Matrix3<f64>),
    /// The finger faults, and its board goes to the end state.
    Fault,
}

impl MotionSettings {
    /// Returns when the set point or path expires, and when the finger faults. Both times count from the beginning of
    /// this validity, s. Each of them is infinite if there is no limit.
    pub fn times(&self, validity: &Validity) -> (f64, f64) {
        let seconds = |time: Option<Duration>| time.map(|time| time.as_secs_f64());
        let hold = seconds(validity.hold_after).or(self.valid).unwrap_or(f64::INFINITY);
        let end = seconds(validity.end_after).or(self.end_state.map(|held| hold + held)).unwrap_or(f64::INFINITY);
        (hold, end)
    }

    /// Returns the settings of `finger` at `rate`, Hz.
    pub fn new(finger: &ConfiguredFinger, rate: f64) -> Self {
        let configured = &finger.motion;
        let held = configured.expired_stiffness.min(finger.stiffness_bound(rate));
        Self {
            interpolation: configured
                .interpolate_ms
                .map(|milliseconds| Interpolation::new(milliseconds * 1e-3, configured.speed, rate)),
            valid: configured.valid_ms.map(|milliseconds| milliseconds * 1e-3),
            end_state: configured.end_state_ms.map(|milliseconds| milliseconds * 1e-3),
            after_expiry: match configured.on_expiry {
                ExpiryReaction::Hold => AfterExpiry::Hold(Matrix3::identity() * held),
                ExpiryReaction::EndState => AfterExpiry::Fault,
            },
        }
    }
}
