//! Feedback of the whole state of a finger on elastic tendons: joint angles and rates, tensions and their rates.
//!
//! The report's loops see the joints through the motors. Between the two lies a spring, and what it swings with must be
//! damped by what the loops do not measure: here it is observed, and every motor is made a force source of little inertia.

mod construction;
mod damping_design;
mod dither;
mod friction_feed_forward;
mod numbers;
mod observer;
mod reference;

use crate::control::signals::Measured;
use crate::control::spring::gravity_compensation::GravityCompensation;
use crate::control::spring::joint_stiffness::JointStiffness;
use crate::control::spring::slew::Slew;
use crate::control::spring::soft_limits::SoftLimits;
use crate::control::spring::spring_transition::Spring;
use crate::control::state_feedback::damping_design::DampingDesign;
use crate::control::state_feedback::dither::{Dither, DitherState};
use crate::control::state_feedback::friction_feed_forward::FrictionFeedForward;
use crate::control::state_feedback::observer::{TendonEstimate, TendonMotion, TendonObserver};
use crate::control::state_feedback::reference::{Reference, ReferenceState};
use crate::control::tendons::bumpless_transfer::Transition;
use crate::control::tendons::tension_distribution::{BoundedDistribution, Distribution};
use crate::model::LinkDynamics;
use nalgebra::{Matrix3, Matrix3x4, Matrix4x3, Vector3, Vector4};
use serde::{Deserialize, Serialize};

/// After so many lost replies or skipped periods in a row what is predicted says nothing any more: the command stays as it is, and the
/// next reply begins anew. With 20 one of five fingers whose servo now and then did not run for 12 ms lost all its tensions.
const BLIND: u32 = 4;

/// The law. SI units inside; the tension distribution and the spring speak N cm.
#[derive(Clone, Debug)]
pub(super) struct StateFeedback {
    /// s.
    period: f64,
    observers: [TendonObserver; 4],
    joint_stiffness: JointStiffness,
    dynamics: LinkDynamics,
    damping: DampingDesign,
    reference: Reference,
    slew: Slew,
    dither: Dither,
    friction: FrictionFeedForward,
    /// R, m.
    r: Matrix3x4<f64>,
    /// R^T (R R^T)^-1, 1/m: its transpose turns the travel of tendons into joint angles, and a common stretch into nothing.
    pseudo_inverse: Matrix4x3<f64>,
    /// The tensions that no joint feels, of length 1.
    common: Vector4<f64>,
    /// R m R^T / alpha, kg m^2: what the joints feel of the motors.
    felt_motors: Matrix3<f64>,
    /// The same as the damping reckons with it.
    damped_motors: Matrix3<f64>,
    /// kg, N s/m and N/m at the tendon.
    mass: Vector4<f64>,
    viscous: Vector4<f64>,
    stiffness: Vector4<f64>,
    /// alpha.
    inertia_gain: f64,
    /// c, N s/m.
    relative_damping: f64,
    /// alpha and c of what the tendons have in common, over those of what turns the joints.
    common_gain: f64,
    common_damping: f64,
    /// N m s/rad and N m.
    joint_viscous: Vector3<f64>,
    joint_coulomb: Vector3<f64>,
    /// Of the low-pass on the drift, a cycle.
    drift_gain: f64,
    /// Rate of fed forward joint friction over the spring's damping.
    rubbing: f64,
    /// s beyond the next sample.
    ahead: f64,
    /// Radius of each motor, m, and half a count of its encoder, rad: a count is rounded down.
    radius: Vector4<f64>,
    half_count: Vector4<f64>,
    /// What the tensions of a finger at rest swing by, N: the dither, and what a gauge leaves open; and near t_max what friction does.
    pub lower_reserve: f64,
    pub upper_reserve: Vector4<f64>,
}

/// What it remembers.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(super) struct StateFeedbackState {
    estimates: [TendonEstimate; 4],
    /// The pull that acts until the next sample, but for what was fed forward against friction, N.
    acting: Vector4<f64>,
    /// Jerk of the reference, rad/s^3.
    jerk: Vector3<f64>,
    lost: u32,
    anchor: Vector3<f64>,
    /// What the tensions still differ by from what the spring asks for. Of tensions, not of pulls: these are noisy, and the
    /// noise of one cycle must not be kept.
    transition: Transition,
    reference: ReferenceState,
    /// How fast the joints move beside the reference, low-passed, rad/s.
    drift: Vector3<f64>,
    dither: DitherState,
    /// Measured joint angles, rad, and joint rates, rad/s.
    pub joints: Vector3<f64>,
    pub joint_rates: Vector3<f64>,
}

/// What a cycle decides.
pub(super) struct Decision {
    /// N.
    pub pulls: Vector4<f64>,
    /// The part of them that is fed forward against friction, N.
    pub against_friction: Vector4<f64>,
    /// N cm.
    pub joint_torques: Vector3<f64>,
    /// With the dither, N.
    pub desired_tensions: Vector4<f64>,
    /// The part of the torque that the bounds let through.
    pub torque_scale: f64,
}

impl StateFeedback {
    /// A finger at rest, under the pull of its tendons.
    pub fn start(&self, measured: &Measured) -> StateFeedbackState {
        let (travel, tensions) = (self.travel(measured), measured.tensions);
        let estimates = std::array::from_fn(|tendon| self.observers[tendon].start(travel[tendon], tensions[tendon]));
        let joints = self.pose(&estimates);
        StateFeedbackState {
            estimates,
            acting: tensions,
            jerk: Vector3::zeros(),
            lost: 0,
            anchor: joints,
            transition: Transition::default(),
            reference: self.reference.start(&joints),
            drift: Vector3::zeros(),
            dither: self.dither.start(),
            joints,
            joint_rates: Vector3::zeros(),
        }
    }

    /// Goes on from the state of another controller of the same finger.
    pub fn take_over(&self, previous: &Self, state: &mut StateFeedbackState) {
        let ratio = self.radius.component_div(&previous.radius);
        for tendon in 0..4 {
            let estimate = &mut state.estimates[tendon];
            self.observers[tendon].take_over(&previous.observers[tendon], estimate, ratio[tendon]);
        }
    }

    /// Whether so many replies are lost in a row that nothing can be decided.
    pub fn blind(&self, state: &StateFeedbackState) -> bool {
        state.lost > BLIND
    }

    /// Takes in a reply, or that it was lost, and goes on to the next sample.
    pub fn observe(&self, state: &mut StateFeedbackState, measured: Option<&Measured>) {
        let was_blind = self.blind(state);
        state.lost = if measured.is_some() { 0 } else { state.lost.saturating_add(1) };
        if self.blind(state) {
            return;
        }
        let measured = measured.map(|measured| (self.travel(measured), measured.tensions));
        let travel_jerk = self.r.tr_mul(&state.jerk);
        for (tendon, observer) in self.observers.iter().enumerate() {
            let estimate = &mut state.estimates[tendon];
            match &measured {
                Some((travel, tensions)) if was_blind => *estimate = observer.start(travel[tendon], tensions[tendon]),
                Some((travel, tensions)) => observer.correct(estimate, travel[tendon], tensions[tendon]),
                None => observer.miss(estimate),
            }
        }
        state.joints = self.pose(&state.estimates);
        for (tendon, observer) in self.observers.iter().enumerate() {
            observer.predict(&mut state.estimates[tendon], state.acting[tendon], travel_jerk[tendon]);
        }
        let speeds = Vector4::from_fn(|tendon, _| self.motion(state, tendon).speed);
        state.joint_rates = self.pseudo_inverse.tr_mul(&speeds);
    }

    /// What was commanded in the end, N, and what of it was against friction.
    pub fn commanded(&self, state: &mut StateFeedbackState, pulls: &Vector4<f64>, against_friction: &Vector4<f64>) {
        state.acting = pulls - against_friction;
    }

    /// No reference moves the finger.
    pub fn idle(&self, state: &mut StateFeedbackState) {
        state.jerk = Vector3::zeros();
    }

    /// The pulls that make the fingertip the spring `spring`, from the next sample on. It `begins` where the finger is.
    pub fn decide(
        &self,
        state: &mut StateFeedbackState,
        spring: &Spring,
        begins: bool,
        limits: &SoftLimits,
        gravity: &GravityCompensation,
        distribution: &BoundedDistribution,
    ) -> Decision {
        if begins {
            // Without deflection.
            state.anchor = state.joints;
            state.reference = self.reference.start(&state.joints);
            state.drift = Vector3::zeros();
            state.dither = self.dither.start();
        }
        let motion: [TendonMotion; 4] = std::array::from_fn(|tendon| self.motion(state, tendon));
        let of = |part: fn(&TendonMotion) -> f64| Vector4::from_fn(|tendon, _| part(&motion[tendon]));
        let (tensions, motor_speeds) = (of(|motion| motion.tension), of(|motion| motion.motor_speed));
        let (speeds, disturbances) = (of(|motion| motion.speed), of(|motion| motion.disturbance));
        let joints = self.pseudo_inverse.tr_mul(&of(|motion| motion.travel));
        let rates = self.pseudo_inverse.tr_mul(&speeds);

        self.slew.advance(&mut state.anchor, &spring.joints);
        let reference = self.reference.advance(&mut state.reference, &state.anchor);
        state.jerk = reference.jerk;

        // The torque of the spring, its damper and the reference's motion.
        let spring = Spring { joints: reference.joints, ..*spring };
        let push = limits.push(&joints);
        let k_theta = self.joint_stiffness.joint_stiffness(&spring, &joints) + Matrix3::from_diagonal(&push.stiffness);
        let k_theta = k_theta * 0.01;
        let inertia = self.dynamics.inertia(&state.joints);
        let felt = self.felt_motors + inertia;
        let damped = self.damped_motors + inertia;
        let damping = self.damping.damping(&damped, &inertia, &k_theta, spring.damping);
        state.drift += (rates - reference.rates - state.drift) * self.drift_gain;
        let moving = reference.rates + state.drift;
        let rubbing = Vector3::from_fn(|joint, _| {
            let most = self.joint_coulomb[joint];
            (self.rubbing * damping[(joint, joint)] * moving[joint]).clamp(-most, most)
        });
        let held = self.joint_stiffness.spring(&spring, &joints) + push.torque + gravity.torques(&joints);
        let torque = held * 0.01 - damping * (rates - reference.rates)
            + felt * reference.accelerations
            + self.dynamics.coriolis(&joints, &reference.rates)
            + self.joint_viscous.component_mul(&reference.rates)
            + rubbing;
        let joint_torques = torque * 100.0;
        let Distribution { tensions: distributed, scale: torque_scale } = distribution.distribute(&joint_torques);
        if begins {
            state.transition.begin(&tensions, &distributed);
        }

        // The tendons as force sources: what the reference and the dither ask of the motors is fed forward.
        let tension_rates = self.pseudo_inverse * (inertia * reference.jerk);
        let tension_accelerations = self.pseudo_inverse * (inertia * reference.snap);
        let motor_rates = self.r.tr_mul(&reference.rates);
        let (shake, quarter_ahead) = self.dither.advance(&mut state.dither);
        let (shake, shake_rates) =
            (self.pseudo_inverse * shake, self.pseudo_inverse * quarter_ahead * self.dither.frequency);
        let omega_squared = self.dither.frequency * self.dither.frequency;
        let desired_tensions = distributed + shake;
        let error = desired_tensions + state.transition.advance(self.period) - tensions;
        let error = self.softer_in_common(&error, self.common_gain);
        // The share of the joints' speed must be exactly 1: with 0.94 it was a drag of three times D.
        let stretching = motor_speeds - speeds - (tension_rates + shake_rates).component_div(&self.stiffness);
        let stretching = self.softer_in_common(&stretching, self.common_damping);
        let yielding = (tension_accelerations - shake * omega_squared).component_div(&self.stiffness);
        let pulls = tensions + error * self.inertia_gain - stretching * self.relative_damping - disturbances
            + self.viscous.component_mul(&motor_rates)
            + self.mass.component_mul(&yielding);
        let against_friction = self.friction.pulls(&motor_speeds, &tensions);
        let pulls = pulls + against_friction;
        Decision { pulls, against_friction, joint_torques, desired_tensions, torque_scale }
    }

    /// `values` with this part of what the tendons have in common.
    fn softer_in_common(&self, values: &Vector4<f64>, part: f64) -> Vector4<f64> {
        values + self.common * (self.common.dot(values) * (part - 1.0))
    }

    fn motion(&self, state: &StateFeedbackState, tendon: usize) -> TendonMotion {
        self.observers[tendon].motion(&state.estimates[tendon], state.acting[tendon], self.ahead)
    }

    /// theta, rad.
    fn pose(&self, estimates: &[TendonEstimate; 4]) -> Vector3<f64> {
        let travel = Vector4::from_fn(|tendon, _| self.observers[tendon].travel(&estimates[tendon]));
        self.pseudo_inverse.tr_mul(&travel)
    }

    /// Travel of the motors, m.
    fn travel(&self, measured: &Measured) -> Vector4<f64> {
        (measured.motor_angles + self.half_count).component_mul(&self.radius)
    }
}
