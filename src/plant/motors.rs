//! The four motors: rotors with viscous and dry friction. The dry friction grows with the tension that loads the shaft.

use super::stribeck::Stribeck;
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;

/// Speed at which the excess of a rotor's friction over its Coulomb friction has fallen to 1/e of the excess at rest,
/// rad/s. With the default motor radius, the tendon moves at 0.24 mm/s then.
const STRIBECK_SPEED: f64 = 0.5;

/// Periods of the torque ripple in a revolution.
const RIPPLE_PERIODS: f64 = 7.0;

/// Parameters of the four rotors, SI units.
#[derive(Clone, Debug)]
pub(super) struct Motors {
    inertia: Vector4<f64>,
    viscous: Vector4<f64>,
    coulomb: Vector4<f64>,
    /// Friction of the shaft as a fraction of the tension torque.
    shaft: f64,
    stribeck: Stribeck,
    torque_limit: Vector4<f64>,
    /// True torque, positive if it pulls, divided by the commanded torque.
    gain: Vector4<f64>,
    /// Amplitude of the torque ripple as a fraction of the torque.
    ripple: f64,
}

impl Motors {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        let simulation = &finger.simulation;
        let sign = Vector4::from(finger.motor.sign.map(f64::from));
        Self {
            inertia: simulation.rotor_inertia.into(),
            viscous: simulation.motor_viscous_friction.into(),
            coulomb: simulation.motor_coulomb_friction.into(),
            shaft: simulation.shaft_friction,
            stribeck: Stribeck::new(simulation.stiction_ratio, STRIBECK_SPEED),
            torque_limit: Vector4::from(finger.motor.torque_limit) * 0.01,
            gain: Vector4::from(simulation.motor_constant_ratio).component_mul(&sign),
            ripple: simulation.torque_ripple,
        }
    }

    /// Returns the torques, N m, that the amplifiers receive: the commanded ones within the motors' limits.
    pub fn limited(&self, commanded: &Vector4<f64>) -> Vector4<f64> {
        commanded.zip_map(&self.torque_limit, |torque, limit| torque.clamp(-limit, limit))
    }

    /// Returns the speeds, rad/s, after one step of `h` seconds. `angles` are in rad. `torques` are those of the
    /// amplifiers, N m. `tension_torque` is the torque with which the tendons pull back, N m.
    pub fn next_speeds(
        &self,
        angles: &Vector4<f64>,
        speeds: &Vector4<f64>,
        torques: &Vector4<f64>,
        tension_torque: &Vector4<f64>,
        h: f64,
    ) -> Vector4<f64> {
        Vector4::from_fn(|motor, _| {
            let mut torque = self.gain[motor] * torques[motor];
            if self.ripple > 0.0 {
                torque *= 1.0 + self.ripple * (RIPPLE_PERIODS * angles[motor]).sin();
            }
            let driving = torque - tension_torque[motor] - self.viscous[motor] * speeds[motor];
            let speed = speeds[motor] + h / self.inertia[motor] * driving;
            let friction = self.coulomb[motor] + self.shaft * tension_torque[motor];
            let friction = friction * self.stribeck.factor(speeds[motor]);
            // Friction can reduce the speed to zero, but cannot reverse it. A rotor at rest stays at rest until the
            // torque exceeds the friction.
            // If the simulation has diverged, the friction is NaN, and f64::clamp would panic with a NaN bound. So
            // f64::max replaces the NaN by 0.
            let loss = (h / self.inertia[motor] * friction).max(0.0);
            speed - speed.clamp(-loss, loss)
        })
    }

    /// Returns the kinetic energy of the rotors, J.
    pub fn energy(&self, speeds: &Vector4<f64>) -> f64 {
        0.5 * self.inertia.dot(&speeds.component_mul(speeds))
    }
}
