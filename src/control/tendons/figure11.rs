//! Figure 11: a motor model that adapts, so that a tension becomes the motor torque that really gives it.

use crate::control::tendons::tension_integral::{TendonInput, TendonState};
use nalgebra::Vector4;

/// What the estimate is clamped to: a motor constant can be off by a half, and friction at t_min adds as much again.
pub(crate) const RATIOS: (f64, f64) = (0.4, 2.0);

/// Below this pull, N, a command says nothing about the motor: its friction holds as much.
const LEAST_PULL: f64 = 2.0;

/// From this part of its limit on a motor counts as being there.
const SATURATED: f64 = 0.98;

/// Below this part of its desired tension a tendon counts as slack.
const SLACK: f64 = 0.2;

/// (t_d - K_delta v) / g, with an estimate g of the tension over the pull that was commanded for it: the M^-1 of eq. 22
/// is multiplied by 1/g. It follows t / pull, the pull being the one that acted when t was measured, with a time
/// constant.
///
/// What adapts is the way from tension to torque only. In (RM)^-T the same M is geometry: an estimate there would move
/// the measured joints, by them the tensions, and by these itself.
#[derive(Clone, Debug)]
pub(crate) struct Figure11 {
    /// Part of the way that the estimate goes in a cycle.
    gain: f64,
    /// K_delta, N s/m at the tendon.
    motor_damping: f64,
}

impl Figure11 {
    /// `adaptation`: 1/s.
    pub fn new(adaptation: f64, motor_damping: f64, rate: f64) -> Self {
        Self { gain: -(-adaptation / rate).exp_m1(), motor_damping }
    }

    pub fn pulls(&self, state: &mut TendonState, input: &TendonInput) -> Vector4<f64> {
        Vector4::from_fn(|tendon, _| {
            let (desired, measured, limit) = (input.desired[tendon], input.measured[tendon], input.limit[tendon]);
            let (acted, ratio) = (input.acted[tendon], &mut state.ratio[tendon]);
            let tells =
                acted >= LEAST_PULL && acted < SATURATED * limit && measured >= SLACK * desired && !input.slack[tendon];
            if tells {
                *ratio = (*ratio + self.gain * (measured / acted - *ratio)).clamp(RATIOS.0, RATIOS.1);
            }
            // As an integral would hold it, for a scheme that has one and goes on from here.
            state.integral[tendon] = desired / *ratio - desired;
            ((desired - self.motor_damping * input.speed[tendon]) / *ratio).clamp(-limit, limit)
        })
    }
}
