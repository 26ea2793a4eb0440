//! Letting go: the pulls ramp to zero.

use nalgebra::Vector4;
use serde::{Deserialize, Serialize};

/// A ramp under way.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct Release {
    /// Pulls at its beginning, N.
    from: Vector4<f64>,
    /// Seconds since.
    elapsed: f64,
}

impl Release {
    pub fn new(from: Vector4<f64>) -> Self {
        Self { from, elapsed: 0.0 }
    }

    /// Pulls of this cycle, N; one cycle takes `period`, the whole ramp `ramp` seconds.
    pub fn advance(&mut self, period: f64, ramp: f64) -> Vector4<f64> {
        self.elapsed += period;
        // A ramp of no length is over in its first cycle.
        let left = if self.elapsed < ramp { 1.0 - self.elapsed / ramp } else { 0.0 };
        self.from * left
    }
}
