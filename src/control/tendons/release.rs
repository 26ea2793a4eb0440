//! Release of the finger: the pulls of the motors at their tendons ramp to zero.

use nalgebra::Vector4;
use serde::{Deserialize, Serialize};

/// A ramp in progress.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct Release {
    /// Pulls at the start of the ramp, N.
    from: Vector4<f64>,
    /// Time since the start, s.
    elapsed: f64,
}

impl Release {
    pub fn new(from: Vector4<f64>) -> Self {
        Self { from, elapsed: 0.0 }
    }

    /// Converts the ramp to other motor radii. `ratio` contains the factors by which the pulls change at the same motor
    /// torques.
    pub fn scale(&mut self, ratio: &Vector4<f64>) {
        self.from.component_mul_assign(ratio);
    }

    /// Advances the ramp by one cycle and returns its pulls, N. `period` is the length of a cycle, and `ramp` is the
    /// length of the whole ramp, both in s.
    pub fn advance(&mut self, period: f64, ramp: f64) -> Vector4<f64> {
        self.elapsed += period;
        // A ramp of zero length ends in its first cycle.
        let left = if self.elapsed < ramp { 1.0 - self.elapsed / ramp } else { 0.0 };
        self.from * left
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_larger_motor_radius_keeps_the_torques_of_the_ramp() {
        let mut release = Release::new(Vector4::repeat(12.0));
        assert_eq!(release.advance(0.25, 1.0), Vector4::repeat(9.0));
        release.scale(&Vector4::repeat(0.5));
        assert_eq!(release.advance(0.25, 1.0), Vector4::repeat(3.0));
    }
}
