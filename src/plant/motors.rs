//! The four motors: rotors with viscous and Coulomb friction, the latter growing with the tension in the conduit.

use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;

/// Parameters of the four rotors, SI.
#[derive(Clone, Debug)]
pub(super) struct Motors {
    inertia: Vector4<f64>,
    viscous: Vector4<f64>,
    coulomb: Vector4<f64>,
    /// Coulomb torque for a tension torque.
    conduit: f64,
    torque_limit: Vector4<f64>,
    /// True torque, positive pulling, over the commanded one.
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

    /// The speeds, rad/s, one step of `h` seconds later. `tension_torque`: what the tendons pull back with, N m.
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
            // Toward zero, never past it: a resting rotor stays at rest until the torque exceeds the friction.
            let loss = h / self.inertia[motor] * friction;
            speed - speed.clamp(-loss, loss)
        })
    }

    /// Kinetic energy of the rotors, J.
    pub fn energy(&self, speeds: &Vector4<f64>) -> f64 {
        0.5 * self.inertia.dot(&speeds.component_mul(speeds))
    }
}
