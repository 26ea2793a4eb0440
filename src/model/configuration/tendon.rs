//! `[finger.tendon]`: tension bounds and stiffness of the tendons.

use serde::{Deserialize, Serialize};

/// `[finger.tendon]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredTendon {
    /// t_min of eq. 19, N. It is also the smallest tension of the homing pretension, at which the encoders are zeroed.
    pub minimum: f64,
    /// t_max, N.
    pub maximum: f64,
    /// Stiffness between motor pulley and joint, N/cm. With it the controller computes the stretch, which the encoders
    /// do not measure.
    pub stiffness: [f64; 4],
    /// Relative uncertainty of `stiffness`. A part of the disagreement between gauges and encoders is attributed to
    /// errors of `stiffness`. The uncertainty limits this part. Identification sets `stiffness_tolerance`.
    pub stiffness_tolerance: f64,
}

impl Default for ConfiguredTendon {
    fn default() -> Self {
        Self { minimum: 5.0, maximum: 60.0, stiffness: [300.0; 4], stiffness_tolerance: 0.4 }
    }
}
