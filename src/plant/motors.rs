//! The four motors: rotors with viscous and Coulomb friction. The Coulomb friction grows with the tension in the
//! conduit.

use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;

/// Parameters of the four rotors, SI units.
#[derive(Clone, Debug)]
pub(super) struct Motors {
    inertia: Vector4<f64>,
    viscous: Vector4<f64>,
    coulomb: Vector4<f64>,
    /// Conduit friction as a fraction of the tension torque.
    conduit: f64,
    torque_limit: Vector4<f64>,
    /// True torque, positive if it pulls, divided by the commanded torque.
    gain: Vector4<f64>,
}

impl Motors {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        let simulation = &finger.simulation;
        let sign = Vector4::from(finger.motor.sign.map(f64::from));
        Self {
            inertia: simulation.rotor_inertia.into(),
            viscous: simulation.motor_viscous_friction.into(),
            coulomb: simulation.motor_coulomb_friction.into(),
            conduit: simulation.conduit_friction,
            torque_limit: Vector4::from(finger.motor.torque_limit) * 0.01,
            gain: Vector4::from(simulation.motor_constant_ratio).component_mul(&sign),
        }
    }

    /// Returns the speeds, rad/s, after one step of `h` seconds. `tension_torque` is the torque with which the tendons
    /// pull back, N m.
    pub fn next_speeds(
        &self,
        speeds: &Vector4<f64>,
        commanded: &Vector4<f64>,
        tension_torque: &Vector4<f64>,
        h: f64,
    ) -> Vector4<f64> {
        Vector4::from_fn(|motor, _| {
            let limit = self.torque_limit[motor];
            let torque = self.gain[motor] * commanded[motor].clamp(-limit, limit);
            let driving = torque - tension_torque[motor] - self.viscous[motor] * speeds[motor];
            let speed = speeds[motor] + h / self.inertia[motor] * driving;
            let friction = self.coulomb[motor] + self.conduit * tension_torque[motor];
            // Friction can reduce the speed to zero, but cannot reverse it. A rotor at rest stays at rest until the
            // torque exceeds the friction.
            let loss = h / self.inertia[motor] * friction;
            speed - speed.clamp(-loss, loss)
        })
    }

    /// Returns the kinetic energy of the rotors, J.
    pub fn energy(&self, speeds: &Vector4<f64>) -> f64 {
        0.5 * self.inertia.dot(&speeds.component_mul(speeds))
    }
}
