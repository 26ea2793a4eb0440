//! The configured friction of the motors and of the conduits that guide their tendons.

use crate::model::Tendons;
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;

/// Friction of a motor and its conduit, N at the tendon: coulomb + conduit t, where t is the tension.
#[derive(Clone, Debug)]
pub(crate) struct MotorFriction {
    /// Coulomb friction at the tendon, N.
    pub coulomb: Vector4<f64>,
    /// Friction of the conduit as a fraction of the tension.
    pub conduit: Vector4<f64>,
}

impl MotorFriction {
    pub fn new(finger: &ConfiguredFinger, tendons: &Tendons) -> Self {
        Self {
            coulomb: Vector4::from(finger.friction.motor_coulomb).component_div(&tendons.radius),
            conduit: finger.friction.conduit.into(),
        }
    }

    /// Returns the friction of one motor, N, at a tension of its tendon, N.
    pub fn at(&self, motor: usize, tension: f64) -> f64 {
        self.coulomb[motor] + self.conduit[motor] * tension
    }
}
