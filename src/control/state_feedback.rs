//! Feedback of the whole state of a finger on elastic tendons: joint angles and rates, tensions and their rates.
//!
//! The report's loops see the joints through the motors. Between the two lies a spring, and what it swings with must be
//! damped by what the loops do not measure: here it is observed, and every motor is made a force source of little
//! inertia.

mod construction;
mod damping_design;
pub(super) mod decision;
mod dither;
mod friction_feed_forward;
mod numbers;
mod observer;
mod reference;

use crate::control::signals::Measured;
use crate::control::spring::joint_stiffness::JointStiffness;
use crate::control::spring::slew::Slew;
use crate::control::state_feedback::damping_design::DampingDesign;
use crate::control::state_feedback::dither::{Dither, DitherState};
use crate::control::state_feedback::friction_feed_forward::FrictionFeedForward;
use crate::control::state_feedback::observer::{TendonEstimate, TendonMotion, TendonObserver};
use crate::control::state_feedback::reference::{Reference, ReferenceState};
use crate::control::tendons::bumpless_transfer::BumplessTransfer;
use crate::model::LinkDynamics;
use nalgebra::{Matrix3, Matrix3x4, Matrix4x3, Vector3, Vector4};
use serde::{Deserialize, Serialize};

/// After so many lost replies or skipped periods in a row what is predicted says nothing any more: the command stays as
/// it is, and the next reply begins anew. With 20 one of five fingers whose servo now and then did not run for 12 ms
/// lost all its tensions.
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
    /// R^T (R R^T)^-1, 1/m: its transpose turns the travel of tendons into joint angles, and a common stretch into
    /// nothing.
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
    /// What the tensions of a finger at rest swing by, N: the dither, and what a gauge leaves open; and near t_max what
    /// friction does.
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
    /// What the tensions still differ by from what the spring asks for. Of tensions, not of pulls: these are noisy, and
    /// the noise of one cycle must not be kept.
    transition: BumplessTransfer,
    reference: ReferenceState,
    /// How fast the joints move beside the reference, low-passed, rad/s.
    drift: Vector3<f64>,
    dither: DitherState,
    /// Measured joint angles, rad, and joint rates, rad/s.
    pub joints: Vector3<f64>,
    pub joint_rates: Vector3<f64>,
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
            transition: BumplessTransfer::default(),
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
