//! The I^2 t limit: a motor may give its largest torque only for a limited time.

use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;
use serde::{Deserialize, Serialize};

/// Fraction of the continuous heat at which the limit of the torque begins to fall. At a fraction of 1 the limit is the
/// continuous torque.
const WARM: f64 = 0.8;

/// The heat of a winding depends on the square of its current, and the torque tau is proportional to the current. So
/// the model computes the heat h as the low-pass filtered square of the torque: h' = (tau^2 - h) / T.
#[derive(Clone, Debug)]
pub(crate) struct MotorHeating {
    /// Largest pull of each motor, N.
    largest: Vector4<f64>,
    /// Pull that each motor may give permanently, N.
    continuous: Vector4<f64>,
    /// Square of `continuous`, N^2.
    continuous_heat: Vector4<f64>,
    /// Change of the heat in a cycle as a fraction of tau^2 - h.
    gain: f64,
    /// Thermal time constant T of the winding, s.
    time: f64,
}

/// The heat h of each motor (see [`MotorHeating`]), N^2, with the torque expressed as pull at the tendon.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(crate) struct Heat(Vector4<f64>);

impl MotorHeating {
    /// Constructs the model. `largest` is the limit of a cold motor, N at the tendon; `radius` is in cm.
    pub fn new(finger: &ConfiguredFinger, largest: Vector4<f64>, radius: &Vector4<f64>, rate: f64) -> Self {
        let continuous = Vector4::from(finger.motor.continuous_torque).component_div(radius).inf(&largest);
        let time = finger.motor.thermal_time;
        let continuous_heat = continuous.component_mul(&continuous);
        Self { largest, continuous, continuous_heat, gain: -(-1.0 / (rate * time)).exp_m1(), time }
    }

    /// Advances the heat by one cycle with these pulls, N.
    pub fn advance(&self, heat: &mut Heat, pulls: &Vector4<f64>) {
        heat.0 += (pulls.component_mul(pulls) - heat.0) * self.gain;
    }

    /// Cools motors that have had no torque for `seconds`.
    pub fn cool(&self, heat: &mut Heat, seconds: f64) {
        heat.0 *= (-seconds / self.time).exp();
    }

    /// Returns the heat of each motor as a fraction of its continuous heat. The fraction can exceed 1.
    pub fn part(&self, heat: &Heat) -> Vector4<f64> {
        heat.0.component_div(&self.continuous_heat)
    }

    /// Returns the largest pull that each motor may give now, N.
    #[inline]
    pub fn limit(&self, heat: &Heat) -> Vector4<f64> {
        let part = self.part(heat);
        Vector4::from_fn(|motor, _| {
            let (largest, continuous) = (self.largest[motor], self.continuous[motor]);
            largest + (continuous - largest) * ((part[motor] - WARM) / (1.0 - WARM)).clamp(0.0, 1.0)
        })
    }
}

impl Heat {
    /// Converts the heat to other motor radii. With these radii, all pulls are multiplied by `ratio`.
    pub fn scale(&mut self, ratio: &Vector4<f64>) {
        self.0.component_mul_assign(&ratio.component_mul(ratio));
    }

    /// Returns the heat, with zero for a heat that is not finite. Only a defect of the controller causes such a heat,
    /// and the finger could never recover from it.
    pub fn if_finite(self) -> Self {
        Self(self.0.map(|heat| if heat.is_finite() { heat } else { 0.0 }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_of_a_motor_falls_to_its_continuous_torque() {
        let finger = ConfiguredFinger::default();
        let heating = MotorHeating::new(&finger, Vector4::repeat(100.0), &Vector4::repeat(0.0475), 100.0);
        let mut heat = Heat::default();
        let mut seconds = 0.0;
        for _ in 0..10_000 {
            let limit = heating.limit(&heat);
            seconds += if limit[0] > 99.9 { 0.01 } else { 0.0 };
            heating.advance(&mut heat, &limit);
        }
        // With the continuous pull c, the limit of a cold motor is l = 1.9 c. It is available until
        // 0.8 c^2 = l^2 (1 - exp(-t / 15 s)).
        assert!((seconds - 3.75f64).abs() < 0.1, "{seconds}");
        assert!((heating.limit(&heat)[0] - 2.5 / 0.0475).abs() < 0.5);
        for _ in 0..1500 {
            heating.advance(&mut heat, &Vector4::zeros());
        }
        assert_eq!(heating.limit(&heat), Vector4::repeat(100.0));
    }
}
