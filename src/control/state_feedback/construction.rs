//! Construction of state feedback from the configuration of a finger.

use super::numbers::Numbers;
use super::{CommonFactors, StateFeedback};
use crate::control::motors::motor_friction::MotorFriction;
use crate::control::number_checks::positive;
use crate::control::spring::admissible_stiffness::stiffness_of_tendons;
use crate::control::spring::joint_stiffness::JointStiffness;
use crate::control::spring::slew::Slew;
use crate::control::state_feedback::damping_design::DampingDesign;
use crate::control::state_feedback::dither::Dither;
use crate::control::state_feedback::friction_feed_forward::FrictionFeedForward;
use crate::control::state_feedback::observer::{ElasticTendon, ObserverDesign, TendonObserver};
use crate::control::state_feedback::periodic_disturbance::PeriodicDisturbance;
use crate::control::state_feedback::pulley_feed_forward::PulleyFeedForward;
use crate::control::state_feedback::reference::Reference;
use crate::control::state_feedback::stiffening::Stiffening;
use crate::control::state_feedback::tension_dither::TensionDither;
use crate::model::configuration::{ConfiguredFinger, Unusable};
use crate::model::{LinkDynamics, Tendons};
use nalgebra::{Matrix3, Matrix3x4, Matrix4x3, Vector3, Vector4};
use std::f64::consts::TAU;

/// Gauge noise for which the observers are designed, N rms.
const GAUGE_NOISE: f64 = 0.03;

/// Distance of the tensions from their bounds, in multiples of [`GAUGE_NOISE`]. The amplitude of the dither is added to
/// this distance.
const NOISE_RESERVE: f64 = 14.0;

/// Additional distance from t_max, as a fraction of the motor's friction at t_max. Friction holds a motor at rest, so
/// the tension of its tendon stays too low or too high until the observer has found the error. At 1000 Hz, 24 poses
/// were simulated with each of 24 seeds. Without this distance, the tensions of a finger at a stop exceeded t_max by up
/// to 0.39 N. With it, they stayed at least 0.46 N below t_max.
const FRICTION_RESERVE: f64 = 0.2;

/// The motors and their tendons as masses on springs, in SI units at the tendon.
struct Drives {
    /// Radius of each motor, m.
    radius: Vector4<f64>,
    /// Mass of each rotor, kg.
    mass: Vector4<f64>,
    /// Viscous friction of each motor, N s/m.
    viscous: Vector4<f64>,
    /// Stiffness of each tendon, N/m.
    stiffness: Vector4<f64>,
    /// Tensions at which the encoders are zeroed, N.
    home: Vector4<f64>,
    /// Angle per encoder count, rad.
    count: [f64; 4],
}

impl Drives {
    fn new(finger: &ConfiguredFinger, tendons: &Tendons) -> Result<Self, Unusable> {
        positive("motor.inertia", &finger.motor.inertia)?;
        positive("tendon.stiffness", &finger.tendon.stiffness)?;
        let radius = tendons.radius * 0.01;
        let squared = radius.component_mul(&radius);
        Ok(Self {
            radius,
            mass: Vector4::from(finger.motor.inertia).component_div(&squared),
            viscous: Vector4::from(finger.motor.viscous_friction).component_div(&squared),
            stiffness: Vector4::from(finger.tendon.stiffness) * 100.0,
            home: tendons.pretension(finger.tendon.minimum),
            count: finger.encoder.counts_per_revolution.map(|counts| std::f64::consts::TAU / f64::from(counts)),
        })
    }

    /// Constructs the observer of one tendon.
    fn observer(
        &self,
        index: usize,
        finger: &ConfiguredFinger,
        numbers: &Numbers,
        rate: f64,
    ) -> Result<TendonObserver, Unusable> {
        let design = ObserverDesign {
            link: numbers.link_bandwidth,
            disturbance: numbers.disturbance_bandwidth,
            encoder_step: self.count[index] * self.radius[index],
            gauge_step: finger.gauge.newton_per_count[index].abs(),
            gauge_noise: GAUGE_NOISE,
        };
        let tendon = ElasticTendon {
            mass: self.mass[index],
            viscous: self.viscous[index],
            stiffness: self.stiffness[index],
            home: self.home[index],
        };
        let too_far = || Unusable {
            key: "tendon.stiffness",
            reason: format!(
                "{} N/cm does not suit a motor mass (motor.inertia / geometry.motor_radius^2) of {} kg, because no \
                 observer for state feedback can be computed for them at {rate} Hz: check these values, and \
                 geometry.motor_radius",
                tendon.stiffness / 100.0,
                tendon.mass
            ),
        };
        TendonObserver::new(tendon, &design, 1.0 / rate).ok_or_else(too_far)
    }

    fn observers(
        &self,
        finger: &ConfiguredFinger,
        numbers: &Numbers,
        rate: f64,
    ) -> Result<[TendonObserver; 4], Unusable> {
        let observer = |index| self.observer(index, finger, numbers, rate);
        Ok([observer(0)?, observer(1)?, observer(2)?, observer(3)?])
    }

    /// Returns the damping c of the motion of the motors relative to the links, N s/m, for a finger that is bent
    /// approximately as in the default pose of zeroing. `r` is in m.
    fn relative_damping(&self, numbers: &Numbers, dynamics: &LinkDynamics, r: &Matrix3x4<f64>) -> f64 {
        let bent = Vector3::new(0.0, 0.5, 1.0);
        let link_mass = (dynamics.inertia(&bent).determinant() / (r * r.transpose()).determinant()).cbrt();
        let (mass, stiffness) = (self.mass.mean(), self.stiffness.mean());
        let frequency = (stiffness / link_mass + numbers.inertia_gain * stiffness / mass).sqrt();
        2.0 * numbers.relative_damping * mass * frequency
    }

    /// Returns the factors a on alpha (`inertia_gain`) and b on c (`relative_damping`) for the common component of the
    /// tensions. The joints do not move with this component. The stretch x of the tendons in this component obeys
    /// m x'' + b c x' + a alpha k x = 0. The factors give this motion a frequency and a damping ratio that do not
    /// depend on the mass m of the rotors. With factors that did not depend on m, the tensions of fingers with rotors
    /// of 2.5 times the inertia were low for up to 287 ms after a bump.
    fn common_factors(&self, numbers: &Numbers, relative_damping: f64) -> CommonFactors {
        let (mass, stiffness) = (self.mass.mean(), self.stiffness.mean());
        let frequency = numbers.common_frequency;
        let gain = mass * frequency * frequency / stiffness;
        let damping = 2.0 * numbers.common_damping_ratio * mass * frequency;
        CommonFactors { gain: gain / numbers.inertia_gain, damping: damping / relative_damping }
    }

    /// Returns R m R^T / alpha, kg m^2: the inertia of the motors that acts on the joints.
    fn apparent_inertia(&self, numbers: &Numbers, r: &Matrix3x4<f64>) -> Matrix3<f64> {
        r * Matrix4x3::from_fn(|tendon, joint| self.mass[tendon] * r[(joint, tendon)]) / numbers.inertia_gain
    }
}

/// Returns R^T (R R^T)^-1.
fn right_inverse(r: &Matrix3x4<f64>) -> Result<Matrix4x3<f64>, Unusable> {
    let reason = "has linearly dependent rows, so the tendons cannot turn each joint independently: check its signs";
    let singular = || Unusable { key: "geometry.r", reason: reason.into() };
    Ok(r.transpose() * (r * r.transpose()).try_inverse().ok_or_else(singular)?)
}

/// Returns the design of the spring's damping. `stiffness` is the stiffness of a tendon, N/m.
fn damping_design(numbers: &Numbers, relative_damping: f64, stiffness: f64) -> DampingDesign {
    DampingDesign {
        ratio: numbers.damping_ratio,
        least_frequency: numbers.least_frequency,
        lag: numbers.lag * relative_damping / (numbers.inertia_gain * stiffness),
    }
}

fn link_dynamics(finger: &ConfiguredFinger) -> Result<LinkDynamics, Unusable> {
    positive("links.masses", &finger.links.masses)?;
    positive("links.radii", &finger.links.radii)?;
    Ok(LinkDynamics::new(finger.links(), finger.links.masses, finger.links.radii, Vector3::zeros()))
}

/// Returns the dither of the tensions. `highest` is the largest permitted tension of each tendon minus the upper
/// reserve, N. After a fast motion, the dither is larger for a short time, the burst. A burst lowers no desired tension
/// to less than `lowest`, N. `lowest` is t_min plus the largest amplitude by which the dither of the joints changes a
/// tension. It contains no reserve for the noise of the gauges, because a burst is short.
fn tension_dither(
    finger: &ConfiguredFinger,
    numbers: &Numbers,
    tendons: &Tendons,
    (lowest, highest): (f64, Vector4<f64>),
    rate: f64,
) -> TensionDither {
    let (pulley, minimum) = (Vector4::from(finger.friction.pulley), finger.tendon.minimum);
    let common = tendons.pretension(minimum).normalize();
    let torques = torques_at_pretension(finger, tendons);
    TensionDither::new(common, numbers, (&pulley, &torques), (lowest, highest), minimum, rate)
}

/// Returns, for each joint, the sum of the magnitudes of the torques of the four tendons at the pretension, N cm.
fn torques_at_pretension(finger: &ConfiguredFinger, tendons: &Tendons) -> Vector3<f64> {
    tendons.r.abs() * tendons.pretension(finger.tendon.minimum)
}

fn stiffening(finger: &ConfiguredFinger, tendons: &Tendons, numbers: &Numbers, rate: f64) -> Option<Stiffening> {
    let identified = finger.friction.pulley.iter().any(|&pulley| pulley > 0.0);
    let torques = torques_at_pretension(finger, tendons);
    Stiffening::new(stiffness_of_tendons(finger, tendons), &torques, identified, numbers, rate)
}

impl StateFeedback {
    /// Constructs the controller with these numbers. `maximum` is the largest permitted tension of each tendon, N.
    /// `set_point_speed` is in rad/s, and `rate` is in Hz.
    pub fn new(
        finger: &ConfiguredFinger,
        numbers: &Numbers,
        tendons: &Tendons,
        maximum: &Vector4<f64>,
        set_point_speed: f64,
        rate: f64,
    ) -> Result<Self, Unusable> {
        let (drives, dynamics) = (Drives::new(finger, tendons)?, link_dynamics(finger)?);
        let r = tendons.r * 0.01;
        let pseudo_inverse = right_inverse(&r)?;
        let relative_damping = drives.relative_damping(numbers, &dynamics, &r);
        let joint_coulomb = Vector3::from(finger.friction.joint_coulomb) * 0.01;
        let shaken = joint_coulomb * numbers.dither;
        let apparent_motors = drives.apparent_inertia(numbers, &r);
        let friction = MotorFriction::new(finger, tendons);
        let shaking = (pseudo_inverse.abs() * shaken).max();
        let lower_reserve = shaking + NOISE_RESERVE * GAUGE_NOISE;
        let upper_reserve =
            Vector4::from_fn(|motor, _| lower_reserve + FRICTION_RESERVE * friction.at(motor, maximum[motor]));
        let (lowest, highest) = (finger.tendon.minimum + shaking, maximum - upper_reserve);
        let tension_dither = tension_dither(finger, numbers, tendons, (lowest, highest), rate);
        let observers = drives.observers(finger, numbers, rate)?;
        Ok(Self {
            period: 1.0 / rate,
            periodic_disturbance: PeriodicDisturbance::new(&observers, TAU * numbers.dither_frequency, rate),
            observers,
            joint_stiffness: JointStiffness::new(finger.links(), 0.0),
            dynamics,
            damping: damping_design(numbers, relative_damping, drives.stiffness.mean()),
            reference: Reference::new(numbers.reference_time, rate),
            slew: Slew::new(set_point_speed, rate),
            dither: Dither::new(shaken, numbers.dither_frequency, rate),
            lower_reserve: lower_reserve + tension_dither.reserve(finger.tendon.minimum + lower_reserve, &highest),
            upper_reserve,
            tension_dither,
            friction: FrictionFeedForward { friction, share: numbers.friction_share },
            pulleys: PulleyFeedForward::new(&finger.friction.pulley.into(), numbers, rate),
            stiffening: stiffening(finger, tendons, numbers, rate),
            r,
            pseudo_inverse,
            common: tendons.pretension(1.0).normalize(),
            apparent_motors,
            damped_motors: apparent_motors * numbers.damped_inertia,
            mass: drives.mass,
            viscous: drives.viscous,
            stiffness: drives.stiffness,
            inertia_gain: numbers.inertia_gain,
            relative_damping,
            common_factors: drives.common_factors(numbers, relative_damping),
            joint_viscous: Vector3::from(finger.friction.joint_viscous) * 0.01,
            joint_coulomb,
            drift_gain: -(-numbers.drift_bandwidth / rate).exp_m1(),
            friction_slope: numbers.friction_slope,
            sample_offset: numbers.sample_offset / rate,
            radius: drives.radius,
            half_count: Vector4::from_fn(|motor, _| 0.5 * drives.count[motor] * f64::from(finger.encoder.sign[motor])),
        })
    }

    /// Returns the period of the dither, s.
    pub fn dither_period(&self) -> f64 {
        TAU / self.dither.frequency
    }
}
