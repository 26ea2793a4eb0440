//! Dither of the joints. It keeps the joints moving slightly, so that static friction does not hold a finger away from
//! the rest position of its spring.

use nalgebra::{Vector2, Vector3};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// The torque A sin(omega t + i 120 degrees) at joint i. Because the three phases differ, the joints are never all at
/// rest at the same time.
#[derive(Clone, Debug)]
pub(crate) struct Dither {
    /// A: amplitude, N m.
    amplitude: Vector3<f64>,
    /// omega: angular frequency, rad/s.
    pub frequency: f64,
    /// Rotation of the phasor in one cycle.
    step: Vector2<f64>,
}

/// Cosine and sine of omega t. Each cycle rotates them, because computing a new cosine and sine takes longer.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct DitherState(Vector2<f64>);

impl Dither {
    /// Constructs a dither from its amplitude, N m, its frequency, Hz, and the rate, Hz.
    pub fn new(amplitude: Vector3<f64>, frequency: f64, rate: f64) -> Self {
        let (sin, cos) = (TAU * frequency / rate).sin_cos();
        Self { amplitude, frequency: TAU * frequency, step: Vector2::new(cos, sin) }
    }

    pub fn start(&self) -> DitherState {
        DitherState(Vector2::x())
    }

    /// Returns sin omega t and cos omega t.
    pub fn phase(&self, state: &DitherState) -> Vector2<f64> {
        Vector2::new(state.0.y, state.0.x)
    }

    /// Returns the torques, N m, and their rates divided by omega, N m, which lead by 90 degrees.
    pub fn advance(&self, state: &mut DitherState) -> (Vector3<f64>, Vector3<f64>) {
        let turned = Vector2::new(
            self.step.x * state.0.x - self.step.y * state.0.y,
            self.step.x * state.0.y + self.step.y * state.0.x,
        );
        // One Newton step normalises the length to 1, so that rounding errors do not accumulate.
        state.0 = turned * (1.5 - 0.5 * turned.norm_squared());
        let (cos, sin) = (state.0.x, state.0.y);
        let (half, high) = (0.5, 0.75f64.sqrt());
        let sines = Vector3::new(sin, -half * sin + high * cos, -half * sin - high * cos);
        let cosines = Vector3::new(cos, -half * cos - high * sin, -half * cos + high * sin);
        (sines.component_mul(&self.amplitude), cosines.component_mul(&self.amplitude))
    }
}
