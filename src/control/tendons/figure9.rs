//! Figure 9 of the report: an integral of the tension error.

use crate::control::tendons::tension_integral::{TendonInput, TendonState, TensionIntegral};
use nalgebra::Vector4;

/// t_d + K_TI/s (t_d - t) - K_delta v, with the desired tension t_d, the measured tension t and the speed v of the
/// motor side.
///
/// The figure contains only the integral. The feed-forward of t_d and the damper are additions of the library, because
/// the loop is unstable at every rate with the integral alone.
#[derive(Clone, Debug)]
pub(crate) struct Figure9 {
    pub integral: TensionIntegral,
    /// K_delta, N s/m at the tendon.
    pub motor_damping: f64,
}

impl Figure9 {
    pub fn pulls(&self, state: &mut TendonState, input: &TendonInput) -> Vector4<f64> {
        let rest = input.desired - input.speed * self.motor_damping;
        self.integral.complete(state, input, &rest)
    }
}
