//! `[finger.stiffness]`: initial stiffness of the fingertip, and its bound.

use serde::{Deserialize, Serialize};

/// `[finger.stiffness]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredStiffness {
    /// Kx with which the finger holds its pose after opening, N/cm, row-major.
    pub initial: [[f64; 3]; 3],
    /// Bound of the largest eigenvalue of Kx, N/cm. Without it the bound is 6 from 1000 Hz up, and 5 below.
    pub bound: Option<f64>,
}

impl Default for ConfiguredStiffness {
    fn default() -> Self {
        Self { initial: [[3.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 3.0]], bound: None }
    }
}

impl ConfiguredStiffness {
    /// Returns the default bound at `rate` Hz, N/cm. It is less than the result of `sun2xp bound --nominal --free` for
    /// the default finger with each controller, except Figure 10 at 500 Hz (`docs/stiffness.md`).
    #[must_use]
    pub fn default_bound(rate: f64) -> f64 {
        if rate >= 1000.0 { 6.0 } else { 5.0 }
    }
}
