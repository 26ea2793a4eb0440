//! Configuration of the zeroing of encoders.

use serde::{Deserialize, Serialize};

/// The method that finds the zero of the encoders.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum ZeroingMethod {
    /// The finger is held in `zeroing.pose_degrees`, by its own spring or from outside.
    Pose,
    /// Every joint is moved to both of its mechanical stops.
    Stops,
    /// The configured zero is kept, if the board reports that its counts are still valid.
    Kept,
}

/// `[finger.zeroing]`
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredZeroing {
    /// The method. Without it `ConfiguredFinger::zeroing_method` selects one.
    pub method: Option<ZeroingMethod>,
    /// Joint angles of the pose in which the finger is held with the method `Pose`, degrees.
    pub pose_degrees: [f64; 3],
    /// Angles of the lower stops, degrees. Without them the stops are 3 degrees beyond the soft limits.
    pub lower_stop_degrees: Option<[f64; 3]>,
    /// Angles of the upper stops, degrees. Without them the stops are 3 degrees beyond the soft limits.
    pub upper_stop_degrees: Option<[f64; 3]>,
    /// Largest torque with which zeroing moves a joint to its stop, N cm. It must be several times the friction of the
    /// joint.
    pub torque: f64,
    /// Speed at which a joint is moved, rad/s.
    pub speed: f64,
    /// Time after which a calibration is abandoned, s.
    pub time_limit_s: f64,
}

impl Default for ConfiguredZeroing {
    fn default() -> Self {
        Self {
            method: None,
            pose_degrees: [0.0, 30.0, 60.0],
            lower_stop_degrees: None,
            upper_stop_degrees: None,
            torque: 2.0,
            speed: 0.7,
            time_limit_s: 120.0,
        }
    }
}
