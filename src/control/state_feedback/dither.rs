//! A small shaking of the joints: friction that never rests does not hold a finger where its spring would not.

use nalgebra::{Vector2, Vector3};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Joint torques A sin(omega t + i 120 degrees): three phases, so that the finger never stands still as a whole.
#[derive(Clone, Debug)]
pub(crate) struct Dither {
    /// A, N m.
    amplitude: Vector3<f64>,
    /// omega, rad/s.
    pub frequency: f64,
    /// Rotation of the phasor in one cycle.
    step: Vector2<f64>,
}

/// Cosine and sine of omega t. Rotated, not computed anew: a cycle has no time to spare.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct DitherState(Vector2<f64>);

impl Dither {
    /// Amplitude, N m; frequency, Hz; cycles a second.
    pub fn new(amplitude: Vector3<f64>, frequency: f64, rate: f64) -> Self {
        let (sin, cos) = (TAU * frequency / rate).sin_cos();
        Self { amplitude, frequency: TAU * frequency, step: Vector2::new(cos, sin) }
    }

    pub fn start(&self) -> DitherState {
        DitherState(Vector2::x())
    }

    /// The torques, N m, and their rates over omega, N m: a quarter of a turn ahead.
    pub fn advance(&self, state: &mut DitherState) -> (Vector3<f64>, Vector3<f64>) {
        let turned = Vector2::new(
            self.step.x * state.0.x - self.step.y * state.0.y,
            self.step.x * state.0.y + self.step.y * state.0.x,
        );
        // Back to length 1 by one step of Newton: rounding must not grow.
        state.0 = turned * (1.5 - 0.5 * turned.norm_squared());
        let (cos, sin) = (state.0.x, state.0.y);
        let (half, high) = (0.5, 0.75f64.sqrt());
        let sines = Vector3::new(sin, -half * sin + high * cos, -half * sin - high * cos);
        let cosines = Vector3::new(cos, -half * cos - high * sin, -half * cos + high * sin);
        (sines.component_mul(&self.amplitude), cosines.component_mul(&self.amplitude))
    }
}
