//! Figure 11: an adaptive motor model, which converts a tension to the motor torque that produces it.

use crate::control::tendons::tension_integral::{TendonInput, TendonState};
use nalgebra::Vector4;

/// Range to which the estimate g of [`Figure11`] is clamped: a motor constant can be wrong by half, and friction at the
/// minimum tension t_min can add an error of the same size.
pub(crate) const RATIOS: (f64, f64) = (0.4, 2.0);

/// Below this pull, N, a command contains no information about the motor, because friction alone can hold a
/// tension of this size.
const LEAST_PULL: f64 = 2.0;

/// Fraction of its limit from which a motor is considered to be saturated.
const SATURATED: f64 = 0.98;

/// Fraction of its desired tension below which a tendon is considered to be slack.
const SLACK: f64 = 0.2;

/// Computes the pull (t_d - K_delta v) / g from the desired tension t_d and the speed v of the motor side. g is an
/// estimate of the quotient of a tension and the pull commanded for it, so the M^-1 of eq. 22 is multiplied by 1/g. (M
/// is the diagonal matrix of the reciprocal motor radii.) A low-pass filter makes g follow t / pull. In this quotient,
/// pull is the pull that acted when the tension t was measured.
///
/// Only the conversion from tension to torque is adapted. The block (RM)^-T of Figure 9, which computes joint angles
/// from motor angles, contains M too. In that block M is not adapted, because it stands for geometry: an estimate would
/// change the measured joint angles, the angles would change the tensions, and the tensions would change the estimate.
#[derive(Clone, Debug)]
pub(crate) struct Figure11 {
    /// Fraction of the remaining difference by which the estimate changes in a cycle.
    gain: f64,
    /// K_delta, N s/m at the tendon.
    motor_damping: f64,
}

impl Figure11 {
    /// Constructs the scheme. `adaptation` is the bandwidth of the estimate, 1/s.
    pub fn new(adaptation: f64, motor_damping: f64, rate: f64) -> Self {
        Self { gain: -(-adaptation / rate).exp_m1(), motor_damping }
    }

    pub fn pulls(&self, state: &mut TendonState, input: &TendonInput) -> Vector4<f64> {
        Vector4::from_fn(|tendon, _| {
            let (desired, measured, limit) = (input.desired[tendon], input.measured[tendon], input.limit[tendon]);
            let (acted, ratio) = (input.acted[tendon], &mut state.ratio[tendon]);
            let informative =
                acted >= LEAST_PULL && acted < SATURATED * limit && measured >= SLACK * desired && !input.slack[tendon];
            if informative {
                *ratio = (*ratio + self.gain * (measured / acted - *ratio)).clamp(RATIOS.0, RATIOS.1);
            }
            // The integral of the other schemes would have this value. It is stored so that another scheme can continue
            // from this state.
            state.integral[tendon] = desired / *ratio - desired;
            ((desired - self.motor_damping * input.speed[tendon]) / *ratio).clamp(-limit, limit)
        })
    }
}
