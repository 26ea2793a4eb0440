//! Input and state of the tendon controllers, and the integral of the tension error that Figures 9 and 10 share, with
//! its anti-windup.

use nalgebra::Vector4;
use serde::{Deserialize, Serialize};

/// The input of a tendon controller in one cycle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TendonInput {
    /// Desired tensions, N.
    pub desired: Vector4<f64>,
    /// Measured tensions, N.
    pub measured: Vector4<f64>,
    /// Low-pass filtered speed of the motor side of each tendon, m/s. A positive speed pulls the tendon in.
    pub speed: Vector4<f64>,
    /// Whether each tendon is slack. The integral of a slack tendon must not grow, because its tension contains no
    /// information about the motor.
    pub slack: [bool; 4],
    /// Largest pull of each motor now, N. It is lower for a warm motor than for a cold one.
    pub limit: Vector4<f64>,
    /// The pull that acted until `measured` was sampled, N.
    pub acted: Vector4<f64>,
}

/// The state of a tendon controller.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct TendonState {
    /// Integral of the tension error, N at the tendon.
    pub integral: Vector4<f64>,
    /// Estimate of Figure 11: the quotient of a tension and the pull commanded for it.
    pub ratio: Vector4<f64>,
}

impl Default for TendonState {
    fn default() -> Self {
        Self { integral: Vector4::zeros(), ratio: Vector4::repeat(1.0) }
    }
}

/// The integral K_TI / s.
#[derive(Clone, Debug)]
pub(crate) struct TensionIntegral {
    /// K_TI divided by the rate, per cycle.
    gain: f64,
}

impl TensionIntegral {
    pub fn new(gain: f64, rate: f64) -> Self {
        Self { gain: gain / rate }
    }

    /// Returns the pull, N. It is the sum of the integral and `rest`, the pull without the integral, N. While the motor
    /// is at its limit, the integral does not grow further toward that limit. When a warm motor's limit falls, the
    /// integral is reduced with it.
    #[inline]
    pub fn complete(&self, state: &mut TendonState, input: &TendonInput, rest: &Vector4<f64>) -> Vector4<f64> {
        Vector4::from_fn(|tendon, _| {
            let limit = input.limit[tendon];
            let error = input.desired[tendon] - input.measured[tendon];
            let before = state.integral[tendon];
            let mut integral = before + self.gain * error;
            if input.slack[tendon] {
                // A negative integral may still return to zero.
                integral = integral.min(before.max(0.0));
            }
            let pull = rest[tendon] + integral;
            let winding_up = pull.abs() > limit && pull * error > 0.0;
            state.integral[tendon] = if !winding_up {
                integral
            } else if pull > 0.0 {
                before.min((limit - rest[tendon]).max(0.0))
            } else {
                before.max((-limit - rest[tendon]).min(0.0))
            };
            (rest[tendon] + state.integral[tendon]).clamp(-limit, limit)
        })
    }
}
