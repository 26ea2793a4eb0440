//! Figure 10 (Salisbury): PI control of the tension error, and a damper on the motor.

use crate::control::tendons::tension_integral::{TendonInput, TendonState, TensionIntegral};
use nalgebra::Vector4;

/// t_d + (K_T + K_TI/s) (t_d - t) - K_delta v, which is the law of the figure with an additional feed-forward of t_d.
/// t_d is the desired tension, t the measured tension, and v the speed of the motor side.
#[derive(Clone, Debug)]
pub(crate) struct Figure10 {
    pub integral: TensionIntegral,
    /// K_T, dimensionless.
    pub tension_gain: f64,
    /// K_delta, N s/m at the tendon.
    pub motor_damping: f64,
}

impl Figure10 {
    pub fn pulls(&self, state: &mut TendonState, input: &TendonInput) -> Vector4<f64> {
        let error = input.desired - input.measured;
        let rest = input.desired + error * self.tension_gain - input.speed * self.motor_damping;
        self.integral.complete(state, input, &rest)
    }
}
