//! The block M^-1 of Figure 9 of the report: motor torques from the pulls at the tendons (eq. 22), with the sign of
//! each motor.

use crate::control::motors::motor_friction::MotorFriction;
use crate::control::number_checks::{positive, signs};
use crate::model::Tendons;
use crate::model::configuration::{ConfiguredFinger, Unusable};
use nalgebra::Vector4;

/// m_tau = M^-1 t = r t.
#[derive(Clone, Debug)]
pub(crate) struct MotorTorque {
    /// Radius of each motor, cm, with the sign of the command that makes the motor pull.
    signed_radius: Vector4<f64>,
    /// Largest pull of each motor, N.
    pub limit: Vector4<f64>,
    friction: MotorFriction,
    /// Fraction of a pull that remains as tension behind each conduit, whose friction opposes the pull.
    past_conduit: Vector4<f64>,
}

impl MotorTorque {
    pub fn new(finger: &ConfiguredFinger, tendons: &Tendons) -> Result<Self, Unusable> {
        signs("motor.sign", &finger.motor.sign)?;
        positive("geometry.motor_radius", &finger.geometry.motor_radius)?;
        positive("motor.torque_limit", &finger.motor.torque_limit)?;
        let friction = MotorFriction::new(finger, tendons);
        Ok(Self {
            signed_radius: tendons.radius.component_mul(&Vector4::from(finger.motor.sign.map(f64::from))),
            limit: Vector4::from(finger.motor.torque_limit).component_div(&tendons.radius),
            past_conduit: friction.conduit.map(|conduit| (1.0 + conduit).recip()),
            friction,
        })
    }

    /// Returns the torques that the board is to apply, N cm, in the board's sign.
    pub fn torques(&self, pulls: &Vector4<f64>) -> Vector4<f64> {
        pulls.component_mul(&self.signed_radius)
    }

    /// Returns the tensions, N, that motors reach with these pulls, N, even if friction opposes them.
    pub fn tensions(&self, pulls: &Vector4<f64>) -> Vector4<f64> {
        (pulls - self.friction.coulomb).component_mul(&self.past_conduit)
    }

    /// Returns the pulls at the tendons, N, for motor torques in the board's sign, N cm.
    pub fn pulls(&self, torques: &Vector4<f64>) -> Vector4<f64> {
        torques.component_div(&self.signed_radius)
    }
}
