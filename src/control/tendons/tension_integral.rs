//! What tendon controllers see and remember, and the integral on the tension error that Figures 9 and 10 share, with
//! its anti-windup.

use nalgebra::Vector4;
use serde::{Deserialize, Serialize};

/// What a tendon controller sees in one cycle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TendonInput {
    /// N.
    pub desired: Vector4<f64>,
    /// N.
    pub measured: Vector4<f64>,
    /// Low-passed speed of the motor side of each tendon, m/s; positive pulls in.
    pub speed: Vector4<f64>,
    /// Where the integral must not grow: a slack tendon's tension says nothing about the motor.
    pub slack: [bool; 4],
    /// Largest pull of each motor now, N: of a warm one less than of a cold one.
    pub limit: Vector4<f64>,
    /// The pull that acted until `measured` was measured, N.
    pub acted: Vector4<f64>,
}

/// The memory of a tendon controller.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct TendonState {
    /// N.
    pub integral: Vector4<f64>,
    /// Estimated tension over the pull that was commanded for it, with Figure 11.
    pub ratio: Vector4<f64>,
}

impl Default for TendonState {
    fn default() -> Self {
        Self { integral: Vector4::zeros(), ratio: Vector4::repeat(1.0) }
    }
}

/// K_TI / s.
#[derive(Clone, Debug)]
pub(crate) struct TensionIntegral {
    /// K_TI over the rate: 1 a cycle.
    gain: f64,
}

impl TensionIntegral {
    pub fn new(gain: f64, rate: f64) -> Self {
        Self { gain: gain / rate }
    }

    /// Adds the integral to `rest`, the pull without it, N. Where the motor is at its limit the integral does not grow
    /// further into it, and where the limit has come down to a warm motor the integral comes down with it.
    pub fn complete(&self, state: &mut TendonState, input: &TendonInput, rest: &Vector4<f64>) -> Vector4<f64> {
        Vector4::from_fn(|tendon, _| {
            let limit = input.limit[tendon];
            let error = input.desired[tendon] - input.measured[tendon];
            let before = state.integral[tendon];
            let mut integral = before + self.gain * error;
            if input.slack[tendon] {
                // What it had learnt to give way may be forgotten.
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
