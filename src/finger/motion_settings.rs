//! What the configuration says about the motion of a finger's set points.

use crate::control::motion::Interpolation;
use crate::model::configuration::{ConfiguredFinger, ExpiryReaction};
use nalgebra::Matrix3;

/// What a servo does with the set points of its planner.
#[derive(Clone, Debug)]
pub struct MotionSettings {
    /// The interpolation of set points, if they are interpolated.
    pub interpolation: Option<Interpolation>,
    /// How long a set point is valid, s; none if it never expires.
    pub valid: Option<f64>,
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
    /// Returns the settings of `finger` at `rate`, Hz.
    pub fn new(finger: &ConfiguredFinger, rate: f64) -> Self {
        let configured = &finger.motion;
        let held = configured.expired_stiffness.min(finger.stiffness_bound(rate));
        Self {
            interpolation: configured
                .interpolate_ms
                .map(|milliseconds| Interpolation::new(milliseconds * 1e-3, configured.speed, rate)),
            valid: configured.valid_ms.map(|milliseconds| milliseconds * 1e-3),
            after_expiry: match configured.on_expiry {
                ExpiryReaction::Hold => AfterExpiry::Hold(Matrix3::identity() * held),
                ExpiryReaction::EndState => AfterExpiry::Fault,
            },
        }
    }
}
