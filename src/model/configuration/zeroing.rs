//! How the encoders of a finger are zeroed.

use serde::{Deserialize, Serialize};

/// How the zero of the encoders is found.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum ZeroingMethod {
    /// The finger is held in `zeroing.pose_degrees`, by its own spring or by something else.
    Pose,
    /// Every joint is led against both of its mechanical stops.
    Stops,
    /// The configured zero stays, if the board says that its counts are still good.
    Kept,
}

/// `[finger.zeroing]`
#[derive(Clone, Debug, Deserialize, Serialize, PartialEq)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredZeroing {
    /// Which way; none: see `ConfiguredFinger::zeroing_method`.
    pub method: Option<ZeroingMethod>,
    /// Joint angles of the pose, degrees.
    pub pose_degrees: [f64; 3],
    /// Where the lower stops are, degrees; none: 3 degrees beyond the soft limits.
    pub lower_stop_degrees: Option<[f64; 3]>,
    /// Where the upper stops are, degrees; none: 3 degrees beyond the soft limits.
    pub upper_stop_degrees: Option<[f64; 3]>,
    /// Largest torque that leads a joint to its stop, N cm: several times its friction.
    pub torque: f64,
    /// Speed at which a joint is led, rad/s.
    pub speed: f64,
    /// After so many seconds a routine gives up.
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
