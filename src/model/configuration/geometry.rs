//! `[finger.geometry]`: link lengths, tendon routing and motor radii.

use serde::{Deserialize, Serialize};

/// `[finger.geometry]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredGeometry {
    /// Link lengths l0, l1, l2, cm.
    pub links: [f64; 3],
    /// R of eq. 14, cm: three rows (joints) with four entries (tendons).
    pub r: [[f64; 4]; 3],
    /// The ghost row of eq. 15. Without it the null vector of R is used.
    pub ghost_row: Option<[f64; 4]>,
    /// Equivalent shaft radius of each motor, cm: tension = torque / radius.
    pub motor_radius: [f64; 4],
}

impl Default for ConfiguredGeometry {
    fn default() -> Self {
        Self {
            links: [3.556, 5.080, 4.000],
            // Entry (2, 4) is -1.09, because eq. 14 has -r24. The report prints +1.09. With +1.09, the 4 x 4 matrix
            // that consists of R and the report's ghost row of ones would be singular.
            r: [[-1.09, 0.62, 0.62, -1.09], [1.09, 0.62, -0.62, -1.09], [0.0, 0.62, -0.62, 0.0]],
            ghost_row: None,
            motor_radius: [0.0475; 4],
        }
    }
}
