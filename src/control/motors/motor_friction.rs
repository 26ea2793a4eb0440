//! The friction of the motors and of the conduits that their tendons run through, as it is configured.

use crate::model::Tendons;
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;

/// Coulomb + conduit t, N at the tendon.
#[derive(Clone, Debug)]
pub(crate) struct MotorFriction {
    /// N.
    pub coulomb: Vector4<f64>,
    /// Share of the tension.
    pub conduit: Vector4<f64>,
}

impl MotorFriction {
    pub fn new(finger: &ConfiguredFinger, tendons: &Tendons) -> Self {
        Self {
            coulomb: Vector4::from(finger.friction.motor_coulomb).component_div(&tendons.radius),
            conduit: finger.friction.conduit.into(),
        }
    }

    /// Of one motor, N, with so much tension in its tendon, N.
    pub fn at(&self, motor: usize, tension: f64) -> f64 {
        self.coulomb[motor] + self.conduit[motor] * tension
    }
}
