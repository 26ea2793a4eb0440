//! Converts the measurements of a finger to physical units, for every calibration routine. The configured sensors and
//! tendons give the factors.

use crate::control::sensing::sensors::SensorScales;
use crate::control::signals::Feedback;
use crate::control::spring::joint_hold::JointHold;
use crate::control::tendons::tension_distribution::TensionDistribution;
use crate::model::Tendons;
use crate::model::configuration::{ConfiguredFinger, Unusable};
use nalgebra::{Vector3, Vector4};

/// The finger as configured, with the gauge offsets and gains found so far.
#[derive(Clone, Debug)]
pub(super) struct Instruments {
    sensors: SensorScales,
    pub tendons: Tendons,
    pub distribution: TensionDistribution,
    /// Pretension of each tendon, N.
    pub pretension: Vector4<f64>,
    /// Compliance of each tendon, cm/N: the reciprocal of `tendon.stiffness`.
    pub compliance: Vector4<f64>,
    /// Configured viscous friction of the joints, N cm s/rad.
    pub joint_viscous: Vector3<f64>,
    pub newton_per_count: Vector4<f64>,
    pub gauge_zero: Vector4<f64>,
    /// Radians per count, with sign.
    pub radians_per_count: Vector4<f64>,
    /// cm of tendon per radian of the motor.
    pub radius: Vector4<f64>,
    /// `radius` with the sign of the motor's command, cm.
    pub signed_radius: Vector4<f64>,
    /// Largest pull of the weakest motor, N.
    pub strongest: f64,
    /// Error of the tensions due to the configured gauge zero, N.
    pub offset: Vector4<f64>,
    /// Factors for the tensions, found so far. They are 1 until the gauges have been compared.
    pub gain: Vector4<f64>,
    /// t_min (`tendon.minimum`), N.
    pub minimum: f64,
    /// t_max (`tendon.maximum`), N.
    pub maximum: f64,
    /// The controller that moves the joints.
    pub hold: JointHold,
    /// Duration of a cycle, s.
    pub period: f64,
}

impl Instruments {
    /// Returns the cm of tendon per count of each encoder, with sign.
    pub fn cm_per_count(&self) -> Vector4<f64> {
        self.radius.component_mul(&self.radians_per_count)
    }

    pub fn new(finger: &ConfiguredFinger, rate: f64) -> Result<Self, Unusable> {
        let tendons = finger.tendons().map_err(|error| Unusable { key: "geometry.r", reason: error.to_string() })?;
        let sensors = SensorScales::new(finger)?;
        let count = |motor: usize| {
            f64::from(finger.encoder.sign[motor]) * std::f64::consts::TAU
                / f64::from(finger.encoder.counts_per_revolution[motor])
        };
        Ok(Self {
            distribution: TensionDistribution::new(
                &tendons,
                finger.tendon.minimum,
                Vector4::repeat(finger.tendon.maximum),
            )?,
            pretension: tendons.pretension(finger.tendon.minimum),
            compliance: Vector4::from(finger.tendon.stiffness).map(f64::recip),
            joint_viscous: finger.friction.joint_viscous.into(),
            newton_per_count: finger.gauge.newton_per_count.into(),
            gauge_zero: finger.gauge.zero.into(),
            radians_per_count: Vector4::from_fn(|motor, _| count(motor)),
            radius: tendons.radius,
            signed_radius: tendons.radius.component_mul(&Vector4::from(finger.motor.sign.map(f64::from))),
            strongest: Vector4::from(finger.motor.torque_limit).component_div(&tendons.radius).min(),
            offset: Vector4::zeros(),
            gain: Vector4::repeat(1.0),
            minimum: finger.tendon.minimum,
            maximum: finger.tendon.maximum,
            hold: JointHold::new(finger.links()),
            period: 1.0 / rate,
            tendons,
            sensors,
        })
    }

    /// Returns the travel of each motor at the tendon from the configured zero, cm. Positive values pull the tendon in.
    pub fn travel(&self, feedback: &Feedback) -> Vector4<f64> {
        self.sensors.motor_angles(feedback).component_mul(&self.radius)
    }

    /// Returns the tensions with the gauge offsets and gains known so far, N.
    pub fn tensions(&self, feedback: &Feedback) -> Vector4<f64> {
        (self.sensors.tensions(feedback) - self.offset).component_mul(&self.gain)
    }

    /// Returns the joint angles, rad, by eq. 27 of COINS TR 90-48, with the stretch of the tendons subtracted from the
    /// travel.
    pub fn joints(&self, travel: &Vector4<f64>, tensions: &Vector4<f64>) -> Vector3<f64> {
        let stretch = (tensions - self.pretension).component_mul(&self.compliance);
        self.tendons.joints_from_travel() * (travel - stretch)
    }

    /// Returns the travel of the motors from the true zero, cm, at the joint angles `joints`, rad, and the tensions
    /// `tensions`, N. This is the inverse of [`joints`](Self::joints).
    pub fn travel_at(&self, joints: &Vector3<f64>, tensions: &Vector4<f64>) -> Vector4<f64> {
        self.tendons.r.tr_mul(joints) + (tensions - self.pretension).component_mul(&self.compliance)
    }

    /// Converts true tensions to set points for the tendon controller, N. The controller does not yet use the offsets
    /// and gains found so far.
    pub fn for_controller(&self, tensions: Vector4<f64>) -> Vector4<f64> {
        tensions.component_div(&self.gain) + self.offset
    }
}
