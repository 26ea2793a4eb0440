//! State feedback from the configuration of a finger.

use super::StateFeedback;
use super::numbers::Numbers;
use crate::control::motors::motor_friction::MotorFriction;
use crate::control::number_checks::positive;
use crate::control::spring::joint_stiffness::JointStiffness;
use crate::control::spring::slew::Slew;
use crate::control::state_feedback::damping_design::DampingDesign;
use crate::control::state_feedback::dither::Dither;
use crate::control::state_feedback::friction_feed_forward::FrictionFeedForward;
use crate::control::state_feedback::observer::{ElasticTendon, ObserverDesign, TendonObserver};
use crate::control::state_feedback::reference::Reference;
use crate::model::configuration::{ConfiguredFinger, Unusable};
use crate::model::{LinkDynamics, Tendons};
use nalgebra::{Matrix4x3, Vector3, Vector4};

/// Noise of a gauge that the observers reckon with, N rms.
const GAUGE_NOISE: f64 = 0.03;

/// How many times that noise the tensions keep off their bounds, beside the dither.
const NOISE_RESERVE: f64 = 14.0;

/// The part of a motor's friction at t_max that its tendon keeps off t_max beside that: a motor at rest is held by its friction, and
/// a tendon keeps what it has until what is missing, or too much, is observed. Without it tendons of a finger at a stop had up to
/// 0.39 N more than t_max at 1000 Hz, with it 0.46 N less, over 24 seeds of 24 poses.
const FRICTION_RESERVE: f64 = 0.2;

/// Of the low-pass on the motion of the joints beside the reference, rad/s: above it dither and noise are, below it pushes.
const DRIFT_BANDWIDTH: f64 = 60.0;

impl StateFeedback {
    /// All numbers from the configuration. `maximum`: what each tendon may have, N.
    pub fn new(
        finger: &ConfiguredFinger,
        tendons: &Tendons,
        maximum: &Vector4<f64>,
        set_point_speed: f64,
        rate: f64,
    ) -> Result<Self, Unusable> {
        let numbers = Numbers::new(&finger.controller, rate)?;
        positive("motor.inertia", &finger.motor.inertia)?;
        positive("tendon.stiffness", &finger.tendon.stiffness)?;
        positive("links.masses", &finger.links.masses)?;
        positive("links.radii", &finger.links.radii)?;
        let radius = tendons.radius * 0.01;
        let squared = radius.component_mul(&radius);
        let mass = Vector4::from(finger.motor.inertia).component_div(&squared);
        let viscous = Vector4::from(finger.motor.viscous_friction).component_div(&squared);
        let stiffness = Vector4::from(finger.tendon.stiffness) * 100.0;
        let home = tendons.pretension(finger.tendon.minimum);
        let r = tendons.r * 0.01;
        let gram = r * r.transpose();
        let singular = || Unusable { key: "geometry.r", reason: "has no right inverse: is a sign wrong?".into() };
        let pseudo_inverse = r.transpose() * gram.try_inverse().ok_or_else(singular)?;

        let count = finger.encoder.counts_per_revolution.map(|counts| std::f64::consts::TAU / f64::from(counts));
        let observer = |index: usize| {
            let design = ObserverDesign {
                link: numbers.link_bandwidth,
                disturbance: numbers.disturbance_bandwidth,
                encoder_step: count[index] * radius[index],
                gauge_step: finger.gauge.newton_per_count[index].abs(),
                gauge_noise: GAUGE_NOISE,
            };
            let tendon = ElasticTendon {
                mass: mass[index],
                viscous: viscous[index],
                stiffness: stiffness[index],
                home: home[index],
            };
            let too_far = || Unusable {
                key: "tendon.stiffness",
                reason: format!(
                    "of {} N/m with {} kg of motor cannot be observed at {rate} Hz",
                    tendon.stiffness, tendon.mass
                ),
            };
            TendonObserver::new(tendon, &design, 1.0 / rate).ok_or_else(too_far)
        };
        let dynamics = LinkDynamics::new(finger.links(), finger.links.masses, finger.links.radii, Vector3::zeros());
        // The frequency of motors against links, for the inertia of a finger bent like at its homing pose.
        let alpha = numbers.inertia_gain;
        let joint_coulomb = Vector3::from(finger.friction.joint_coulomb) * 0.01;
        let bent = Vector3::new(0.0, 0.5, 1.0);
        let link_mass = (dynamics.inertia(&bent).determinant() / gram.determinant()).cbrt();
        let (mean_mass, mean_stiffness) = (mass.mean(), stiffness.mean());
        let frequency = (mean_stiffness / link_mass + alpha * mean_stiffness / mean_mass).sqrt();
        let relative_damping = 2.0 * numbers.relative_damping * mean_mass * frequency;
        let shaken = joint_coulomb * numbers.dither;
        let felt_motors = r * Matrix4x3::from_fn(|tendon, joint| mass[tendon] * r[(joint, tendon)]) / alpha;
        let common = tendons.pretension(1.0).normalize();
        let friction = MotorFriction::new(finger, tendons);
        let lower_reserve = (pseudo_inverse.abs() * shaken).max() + NOISE_RESERVE * GAUGE_NOISE;
        Ok(Self {
            period: 1.0 / rate,
            observers: [observer(0)?, observer(1)?, observer(2)?, observer(3)?],
            joint_stiffness: JointStiffness::new(finger.links(), 0.0),
            dynamics,
            damping: DampingDesign {
                ratio: numbers.damping_ratio,
                least_frequency: numbers.least_frequency,
                lag: numbers.lag * relative_damping / (alpha * mean_stiffness),
            },
            reference: Reference::new(numbers.reference_time, rate),
            slew: Slew::new(set_point_speed, rate),
            dither: Dither::new(shaken, numbers.dither_frequency, rate),
            lower_reserve,
            upper_reserve: Vector4::from_fn(|motor, _| {
                lower_reserve + FRICTION_RESERVE * friction.at(motor, maximum[motor])
            }),
            friction: FrictionFeedForward(friction),
            r,
            pseudo_inverse,
            common,
            felt_motors,
            damped_motors: felt_motors * numbers.felt,
            mass,
            viscous,
            stiffness,
            inertia_gain: alpha,
            relative_damping,
            common_gain: numbers.common_gain,
            common_damping: numbers.common_damping,
            joint_viscous: Vector3::from(finger.friction.joint_viscous) * 0.01,
            joint_coulomb,
            drift_gain: -(-DRIFT_BANDWIDTH / rate).exp_m1(),
            rubbing: numbers.rubbing,
            ahead: numbers.ahead / rate,
            radius,
            half_count: Vector4::from_fn(|motor, _| 0.5 * count[motor] * f64::from(finger.encoder.sign[motor])),
        })
    }
}
