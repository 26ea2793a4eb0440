//! `[finger.joints]`: soft limits of the joints.

use serde::{Deserialize, Serialize};

/// `[finger.joints]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredJoints {
    /// Lower soft limits, degrees.
    pub minimum_degrees: [f64; 3],
    /// Upper soft limits, degrees.
    pub maximum_degrees: [f64; 3],
}

impl Default for ConfiguredJoints {
    fn default() -> Self {
        Self { minimum_degrees: [-60.0, -30.0, 5.0], maximum_degrees: [60.0, 100.0, 120.0] }
    }
}
