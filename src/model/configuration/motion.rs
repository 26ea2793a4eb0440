//! `[finger.motion]`: limits of paths, and interpolation and expiry of set points.

use serde::{Deserialize, Serialize};

/// `[finger.motion]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredMotion {
    /// Largest rate of a joint on a path, and of an interpolated set point, rad/s.
    pub speed: f64,
    /// Largest acceleration of a joint on a path, rad/s^2.
    pub acceleration: f64,
    /// Largest jerk of a joint on a path, rad/s^3.
    pub jerk: f64,
    /// Period of the planner's set points, ms. The motion to each set point is spread over three such periods, or more
    /// if the set point is far. A period below 10 ms acts as 10 ms. With `None`, set points are not interpolated.
    pub interpolate_ms: Option<f64>,
    /// Time for which a set point is valid, ms. With `None`, set points do not expire.
    pub valid_ms: Option<f64>,
    /// The reaction to a set point that has expired.
    pub on_expiry: ExpiryReaction,
    /// Time for which a finger holds its pose after its set point has expired, ms. Then it faults, and its board goes
    /// to the end state. With `None`, the finger holds its pose indefinitely.
    pub end_state_ms: Option<f64>,
    /// Stiffness, equal in every direction, with which a finger holds its pose after its set point has expired, N/cm.
    pub expired_stiffness: f64,
}

/// The reaction to a set point that has expired.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub enum ExpiryReaction {
    /// The finger holds the pose in which it is, with a soft stiffness.
    #[default]
    #[serde(rename = "hold")]
    Hold,
    /// The finger faults, and its board goes to the end state.
    #[serde(rename = "end state")]
    EndState,
}

impl Default for ConfiguredMotion {
    fn default() -> Self {
        Self {
            speed: 5.0,
            acceleration: 100.0,
            jerk: 5000.0,
            interpolate_ms: None,
            valid_ms: None,
            on_expiry: ExpiryReaction::default(),
            end_state_ms: None,
            expired_stiffness: 1.0,
        }
    }
}
