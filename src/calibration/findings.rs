//! The results of the calibration routines, and the configuration keys of a finger that store them.

use crate::model::configuration::ConfiguredFinger;
use nalgebra::{Matrix3x4, Vector3, Vector4};

/// The results of one calibration routine.
// The servo does not use the heap, so the large variants are not boxed.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Findings {
    /// Results of [`Task::Signs`](super::Task::Signs).
    Signs(Signs),
    /// [`Task::SelfTest`](super::Task::SelfTest) has found nothing wrong.
    RightWiring,
    /// Results of [`Task::Zero`](super::Task::Zero).
    Zeros(Zeros),
    /// Results of [`Task::Identify`](super::Task::Identify).
    Identified(Identified),
}

/// Signs of motors, encoders and gauges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signs {
    /// `motor.sign`.
    pub motor: [i8; 4],
    /// `encoder.sign`.
    pub encoder: [i8; 4],
    /// +1 if the gauge's count rises with the tension: the sign of `gauge.newton_per_count`.
    pub gauge: [i8; 4],
}

/// Zeros of the sensors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zeros {
    /// `encoder.zero`, counts: m_0 of eq. 28 of COINS TR 90-48.
    pub encoder: [i32; 4],
    /// `gauge.zero`, counts.
    pub gauge: [f64; 4],
    /// Error of the joint angles before zeroing, rad.
    pub joint_error: Vector3<f64>,
    /// Measured minus configured angle between the two stops of each joint, rad. `None` if the routine did not move to
    /// the stops.
    pub range_error: Option<Vector3<f64>>,
}

/// Friction, elasticity, gauge gains, rotor inertia and moment arms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Identified {
    /// `tendon.stiffness`, N/cm.
    pub tendon_stiffness: Vector4<f64>,
    /// `tendon.stiffness_tolerance`. The true stretch per newton depends on the tension, but `tendon_stiffness` stands
    /// for a constant stretch per newton. The tolerance is the largest relative difference between the two, plus the
    /// uncertainty of the measurement.
    pub stiffness_tolerance: f64,
    /// Part of the motors' travel that the identified elasticity does not explain: rms residual, cm.
    pub travel_residual: f64,
    /// The errors that the monitors must tolerate after the identification.
    pub tolerances: Tolerances,
    /// `friction.motor_coulomb`, N cm of commanded torque.
    pub motor_coulomb: Vector4<f64>,
    /// `friction.conduit`.
    pub conduit: Vector4<f64>,
    /// `friction.pulley`.
    pub pulley: Vector4<f64>,
    /// Factors for `gauge.newton_per_count`. Their ratios to each other are measured. Their mean comes from the source
    /// that `gauge.reference` selects.
    pub gauge_gain: Vector4<f64>,
    /// Ratio of each motor's true torque to its commanded torque, if the gauges are right. Without a known weight, a
    /// common error of the gauges cannot be distinguished from a common error of the motors.
    pub motor_ratio: Vector4<f64>,
    /// `friction.joint_coulomb`, N cm.
    pub joint_coulomb: Vector3<f64>,
    /// Viscous friction of the joints, N cm s/rad.
    pub joint_viscous: Vector3<f64>,
    /// `motor.inertia`, kg m^2, if it differs from the configured one. It is divided by the ratio of the true torque to
    /// the commanded torque, because the controller computes with commanded torques.
    pub rotor_inertia: Option<Vector4<f64>>,
    /// The moment arms, if they differ from the configured ones.
    pub moment_arms: Option<IdentifiedArms>,
}

/// Measured moment arms, and the encoder zeros that belong to them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdentifiedArms {
    /// `geometry.r`, cm.
    pub r: Matrix3x4<f64>,
    /// `encoder.zero`, counts.
    pub encoder_zero: [i32; 4],
}

/// Uncertainty of friction, moment arms and gauges after an identification, from the residuals of its fits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// `monitors.friction_tolerance`.
    pub friction: f64,
    /// `monitors.moment_arm_tolerance`, if the moment arms were measured.
    pub moment_arms: Option<f64>,
    /// `monitors.gauge_tolerance`.
    pub gauges: f64,
}

impl Identified {
    /// Returns the results that follow if every true tension is `factor` times the tension used to compute `self`.
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

impl IdentifiedArms {
    /// Returns the rows of R.
    pub(crate) fn rows(&self) -> [[f64; 4]; 3] {
        std::array::from_fn(|joint| std::array::from_fn(|tendon| self.r[(joint, tendon)]))
    }
}

impl Findings {
    /// Writes into a finger's configuration every result whose documentation names a configuration key. The viscous
    /// friction of the joints is not written.
    pub fn apply(&self, finger: &mut ConfiguredFinger) {
        match self {
            Self::Signs(signs) => {
                finger.motor.sign = signs.motor;
                finger.encoder.sign = signs.encoder;
                for (scale, sign) in finger.gauge.newton_per_count.iter_mut().zip(signs.gauge) {
                    *scale = scale.abs() * f64::from(sign);
                }
            }
            Self::RightWiring => {}
            Self::Zeros(zeros) => {
                finger.encoder.zero = zeros.encoder;
                finger.gauge.zero = zeros.gauge;
            }
            Self::Identified(found) => {
                for (scale, gain) in finger.gauge.newton_per_count.iter_mut().zip(&found.gauge_gain) {
                    *scale *= gain;
                }
                finger.tendon.stiffness = found.tendon_stiffness.into();
                finger.tendon.stiffness_tolerance = found.stiffness_tolerance;
                finger.friction.motor_coulomb = found.motor_coulomb.into();
                finger.friction.conduit = found.conduit.into();
                finger.friction.pulley = found.pulley.into();
                finger.friction.joint_coulomb = found.joint_coulomb.into();
                finger.monitors.friction_tolerance = found.tolerances.friction;
                finger.monitors.gauge_tolerance = found.tolerances.gauges;
                if let Some(tolerance) = found.tolerances.moment_arms {
                    finger.monitors.moment_arm_tolerance = tolerance;
                }
                if let Some(inertia) = found.rotor_inertia {
                    finger.motor.inertia = inertia.into();
                }
                if let Some(arms) = &found.moment_arms {
                    finger.geometry.r = arms.rows();
                    finger.encoder.zero = arms.encoder_zero;
                }
            }
        }
    }
}
