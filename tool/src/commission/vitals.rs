//! The measurements of a finger at its commissioning or on a later day, for comparisons.

use serde::{Deserialize, Serialize};

/// The measurements of a finger on one day. A step that was not done leaves its values empty.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
#[serde(default)]
pub struct Vitals {
    /// Count of each gauge without tension.
    pub gauge_zero: Option<[f64; 4]>,
    /// Noise of each gauge while the motors are off, N rms.
    pub gauge_noise: Option<[f64; 4]>,
    pub newton_per_count: Option<[f64; 4]>,
    pub encoder_zero: Option<[i32; 4]>,
    /// Tensions of the tendons while the finger is a spring at rest, N.
    pub tensions: Option<[f64; 4]>,
    /// Torques of the motors that hold these tensions, N cm.
    pub torques: Option<[f64; 4]>,
    /// N/cm.
    pub tendon_stiffness: Option<[f64; 4]>,
    /// N cm.
    pub motor_friction: Option<[f64; 4]>,
    pub conduit_friction: Option<[f64; 4]>,
    pub pulley_friction: Option<[f64; 4]>,
    /// N cm.
    pub joint_friction: Option<[f64; 3]>,
    /// True torque of each motor divided by the commanded torque.
    pub motor_ratio: Option<[f64; 4]>,
    /// Part of the travel of the motors that elasticity does not explain, cm rms.
    pub residual: Option<f64>,
}
