//! `[finger.contact]`: the thresholds for the detection of contacts without touch sensors.

use serde::{Deserialize, Serialize};

/// `[finger.contact]`. docs/contact.md lists the forces that are detected with the defaults.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredContact {
    /// Bandwidth with which the estimated torques follow the true ones, 1/s.
    pub bandwidth: f64,
    /// Least force at the tip with which a finger at rest counts as touching something, N.
    pub force: f64,
    /// Increase of `force` with the rate of the fastest joint, N s/rad.
    pub force_per_rate: f64,
    /// A contact must exceed this torque at one or more joints, N cm. The value must exceed the errors that noise,
    /// dither and joint friction cause.
    pub torque: [f64; 3],
    /// Relative uncertainty of the masses of the links. It raises `torque` while joints accelerate, and when the
    /// torques of gravity change.
    pub mass_tolerance: f64,
    /// A contact is lost when the force at the tip falls below this fraction of the threshold for the force, or when
    /// the torque at every joint falls below this fraction of the threshold for that joint.
    pub lost: f64,
    /// Time constant with which a constant error of the torques is learned while nothing is touched, s.
    pub learning_time_s: f64,
}

impl Default for ConfiguredContact {
    fn default() -> Self {
        Self {
            bandwidth: 60.0,
            force: 0.06,
            force_per_rate: 0.15,
            torque: [0.25, 0.1, 0.09],
            mass_tolerance: 0.4,
            lost: 0.6,
            learning_time_s: 2.0,
        }
    }
}
