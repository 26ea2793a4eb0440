//! What the routines find, and where it belongs in a finger's configuration.

use crate::model::configuration::ConfiguredFinger;
use nalgebra::{Vector3, Vector4};

/// `tendon.stiffness_tolerance` of what was identified. On the simulated finger it is right to 0.2 %; a real tendon is
/// no straight spring.
const STIFFNESS_TOLERANCE: f64 = 0.03;

/// Results of one routine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Findings {
    /// Of [`Task::Signs`](super::Task::Signs).
    Signs(Signs),
    /// Of [`Task::Zero`](super::Task::Zero).
    Zeros(Zeros),
    /// Of [`Task::Identify`](super::Task::Identify).
    Identified(Identified),
}

/// Which way motors, encoders and gauges count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signs {
    /// `motor.sign`.
    pub motor: [i8; 4],
    /// `encoder.sign`.
    pub encoder: [i8; 4],
    /// +1 where the gauge's count rises with the tension: the sign of `gauge.newton_per_count`.
    pub gauge: [i8; 4],
}

/// Zeros of the sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zeros {
    /// `encoder.zero`, m_0 of eq. 28.
    pub encoder: [i32; 4],
    /// `gauge.zero`.
    pub gauge: [f64; 4],
    /// How far the joint angles were off before, rad.
    pub joint_error: Vector3<f64>,
    /// Angle between the two stops of each joint less the configured one, rad; none where no stop was sought.
    pub range_error: Option<Vector3<f64>>,
}

/// Friction and elasticity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Identified {
    /// `tendon.stiffness`, N/cm.
    pub tendon_stiffness: Vector4<f64>,
    /// How well the four stiffnesses explain the travel of the motors: rms of what is left, cm.
    pub travel_residual: f64,
    /// `friction.motor_coulomb`, N cm of commanded torque.
    pub motor_coulomb: Vector4<f64>,
    /// `friction.conduit`.
    pub conduit: Vector4<f64>,
    /// What `gauge.newton_per_count` is to be multiplied by. Relative to each other the gains are measured; their mean
    /// is taken from `gauge.reference`.
    pub gauge_gain: Vector4<f64>,
    /// True torque of each motor over the commanded one, if the gauges are right by now: without a known weight a
    /// common error of the gauges cannot be told from one of the motors.
    pub motor_ratio: Vector4<f64>,
    /// `friction.joint_coulomb`, N cm.
    pub joint_coulomb: Vector3<f64>,
    /// Viscous friction of the joints, N cm s/rad.
    pub joint_viscous: Vector3<f64>,
}

impl Identified {
    /// The same with every tension `factor` times larger.
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self {
            tendon_stiffness: self.tendon_stiffness * factor,
            conduit: self.conduit / factor,
            gauge_gain: self.gauge_gain * factor,
            motor_ratio: self.motor_ratio * factor,
            joint_coulomb: self.joint_coulomb * factor,
            joint_viscous: self.joint_viscous * factor,
            ..self
        }
    }
}

impl Findings {
    /// Writes the results to where they belong.
    pub fn apply(&self, finger: &mut ConfiguredFinger) {
        match self {
            Self::Signs(signs) => {
                finger.motor.sign = signs.motor;
                finger.encoder.sign = signs.encoder;
                for (scale, sign) in finger.gauge.newton_per_count.iter_mut().zip(signs.gauge) {
                    *scale = scale.abs() * f64::from(sign);
                }
            }
            Self::Zeros(zeros) => {
                finger.encoder.zero = zeros.encoder;
                finger.gauge.zero = zeros.gauge;
            }
            Self::Identified(found) => {
                for (scale, gain) in finger.gauge.newton_per_count.iter_mut().zip(&found.gauge_gain) {
                    *scale *= gain;
                }
                finger.tendon.stiffness = found.tendon_stiffness.into();
                finger.tendon.stiffness_tolerance = STIFFNESS_TOLERANCE;
                finger.friction.motor_coulomb = found.motor_coulomb.into();
                finger.friction.conduit = found.conduit.into();
                finger.friction.joint_coulomb = found.joint_coulomb.into();
            }
        }
    }
}
