//! Feedback of the whole state of a finger on elastic tendons: joint angles and rates, tensions and their rates.
//!
//! The loops of the report (COINS TR 90-48) measure the joints through the motors. The tendons between motors and
//! joints are springs. Their oscillation must be damped with quantities that the report's loops do not measure. This
//! controller observes these quantities, and makes every motor a force source with little inertia.

mod construction;
mod damping_design;
pub(super) mod decision;
mod dither;
mod dither_burst;
mod dither_scale;
mod friction_feed_forward;
mod full_rate;
mod matrix_exponential;
mod numbers;
mod observer;
mod periodic_disturbance;
mod pulley_feed_forward;
mod reference;
mod stiffening;
mod tension_dither;

pub use numbers::Numbers;

use crate::control::motion::Motion;
use crate::control::signals::Measured;
use crate::control::spring::joint_stiffness::JointStiffness;
use crate::control::spring::slew::Slew;
use crate::control::state_feedback::damping_design::DampingDesign;
use crate::control::state_feedback::dither::{Dither, DitherState};
use crate::control::state_feedback::friction_feed_forward::FrictionFeedForward;
use crate::control::state_feedback::observer::{TendonEstimate, TendonMotion, TendonObserver};
use crate::control::state_feedback::periodic_disturbance::{PeriodicDisturbance, PeriodicDisturbanceState};
use crate::control::state_feedback::pulley_feed_forward::PulleyFeedForward;
use crate::control::state_feedback::reference::{Reference, ReferenceMotion, ReferenceState};
use crate::control::state_feedback::stiffening::{Stiffening, StiffeningState};
use crate::control::state_feedback::tension_dither::{TensionDither, TensionDitherState};
use crate::control::tendons::bumpless_transfer::BumplessTransfer;
use crate::model::LinkDynamics;
use nalgebra::{Matrix3, Matrix3x4, Matrix4x3, Vector3, Vector4};
use serde::{Deserialize, Serialize};

/// Largest number of consecutive lost replies or skipped periods for which the predictions are used. After more losses,
/// the command stays constant, and the next reply restarts the observers. A limit of 20 was tried with five fingers
/// whose servo occasionally did not run for 12 ms. One of them lost all its tensions.
const BLIND: u32 = 4;

/// The control law, in SI units. The tension distribution and the spring use N cm.
#[derive(Clone, Debug)]
pub(super) struct StateFeedback {
    /// Period, s.
    period: f64,
    observers: [TendonObserver; 4],
    joint_stiffness: JointStiffness,
    dynamics: LinkDynamics,
    damping: DampingDesign,
    reference: Reference,
    slew: Slew,
    dither: Dither,
    tension_dither: TensionDither,
    periodic_disturbance: PeriodicDisturbance,
    friction: FrictionFeedForward,
    pulleys: Option<PulleyFeedForward>,
    stiffening: Option<Stiffening>,
    /// R, m.
    r: Matrix3x4<f64>,
    /// R^T (R R^T)^-1, 1/m. Its transpose converts the travel of the tendons to joint angles. The transpose converts a
    /// stretch along the null vector of R to zero.
    pseudo_inverse: Matrix4x3<f64>,
    /// Unit vector of the tensions that cause no joint torque.
    common: Vector4<f64>,
    /// R m R^T / alpha, kg m^2: the inertia of the motors that acts on the joints.
    apparent_motors: Matrix3<f64>,
    /// The inertia of the motors for which the damping is designed, kg m^2.
    damped_motors: Matrix3<f64>,
    /// Mass of each motor at its tendon, kg.
    mass: Vector4<f64>,
    /// Viscous friction of each motor at its tendon, N s/m.
    viscous: Vector4<f64>,
    /// Stiffness of each tendon, N/m.
    stiffness: Vector4<f64>,
    /// alpha: the gain from the tension error to the pull of a motor.
    inertia_gain: f64,
    /// c: damping of the speed of a motor relative to the joint side of its tendon, N s/m.
    relative_damping: f64,
    common_factors: CommonFactors,
    /// Viscous friction of the joints, N m s/rad.
    joint_viscous: Vector3<f64>,
    /// Coulomb friction of the joints, N m.
    joint_coulomb: Vector3<f64>,
    /// Gain per cycle of the low-pass filter on the drift, which is the joint rates minus the rates of the reference.
    drift_gain: f64,
    /// Slope of the joint friction feed-forward, as a fraction of the spring's damping.
    friction_slope: f64,
    /// The motion is computed for this time relative to the next sample, s. A negative time is before the sample.
    sample_offset: f64,
    /// Radius of each motor, m.
    radius: Vector4<f64>,
    /// Half an encoder count, rad, with the sign of the encoder. It is added because counts are rounded down.
    half_count: Vector4<f64>,
    /// Margin to the lower tension bound, N. Dither and gauge noise vary the tensions of a finger at rest.
    pub lower_reserve: f64,
    /// Margins to the upper tension bounds, N. Near t_max friction varies the tensions too.
    pub upper_reserve: Vector4<f64>,
}

/// Factors of the common component of the tensions, which causes no joint torque, relative to the components that turn
/// the joints.
#[derive(Clone, Copy, Debug)]
struct CommonFactors {
    /// Factor on alpha.
    gain: f64,
    /// Factor on c.
    damping: f64,
}

/// The state of the control law.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(super) struct StateFeedbackState {
    estimates: [TendonEstimate; 4],
    /// The pull that acts until the next sample, without the friction feed-forward, N.
    acting: Vector4<f64>,
    /// Jerk of the reference, rad/s^3.
    jerk: Vector3<f64>,
    lost: u32,
    anchor: Vector3<f64>,
    /// Difference between the estimated and the desired tensions when the finger began to follow set points, N. It
    /// decays to zero. It is a difference of tensions and not of pulls, because pulls are noisy and the noise of one
    /// cycle must not persist.
    transition: BumplessTransfer,
    reference: ReferenceState,
    /// The outputs that the filter stages of the reference would have if the reference were equal to the set point of
    /// the last cycle. `None` if that set point was at rest.
    #[serde(default)]
    along: Option<ReferenceState>,
    /// Joint rates minus the rates of the reference, low-pass filtered, rad/s.
    drift: Vector3<f64>,
    /// Speed of each tendon at the joints while the reference is at rest, low-pass filtered, m/s.
    #[serde(default)]
    creep: Vector4<f64>,
    #[serde(default)]
    stiffening: StiffeningState,
    dither: DitherState,
    tension_dither: TensionDitherState,
    #[serde(default)]
    periodic_disturbance: PeriodicDisturbanceState,
    /// Estimated joint angles at the newest sample, rad.
    pub joints: Vector3<f64>,
    /// Estimated joint rates, predicted for `sample_offset` relative to the next sample, rad/s.
    pub joint_rates: Vector3<f64>,
}

impl StateFeedback {
    /// Returns the state of a finger at rest, whose motors pull with the measured tensions.
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
            along: None,
            drift: Vector3::zeros(),
            creep: Vector4::zeros(),
            stiffening: StiffeningState::default(),
            dither: self.dither.start(),
            tension_dither: self.tension_dither.start(),
            periodic_disturbance: PeriodicDisturbanceState::default(),
            joints,
            joint_rates: Vector3::zeros(),
        }
    }

    /// Continues from the state of another controller of the same finger.
    pub fn take_over(&self, previous: &Self, state: &mut StateFeedbackState) {
        let ratio = self.radius.component_div(&previous.radius);
        state.acting.component_div_assign(&ratio);
        for tendon in 0..4 {
            let estimate = &mut state.estimates[tendon];
            self.observers[tendon].take_over(&previous.observers[tendon], estimate, ratio[tendon]);
        }
        self.reference.take_over(&previous.reference, &mut state.reference, &mut state.anchor, &mut state.along);
    }

    /// Notes that a path begins with the next set point, which has these joint angles, rad, and this motion. The last
    /// set point may have moved differently.
    pub fn begin_path(&self, state: &mut StateFeedbackState, joints: &Vector3<f64>, motion: &Motion) {
        self.reference.replace_along(&mut state.along, joints, motion, self.period);
    }

    /// Returns whether so many consecutive replies were lost that no command can be computed.
    pub fn blind(&self, state: &StateFeedbackState) -> bool {
        state.lost > BLIND
    }

    /// Updates the observers with a reply, or with the loss of one, and predicts the next sample.
    pub fn observe(&self, state: &mut StateFeedbackState, measured: Option<&Measured>) {
        let was_blind = self.blind(state);
        state.lost = if measured.is_some() { 0 } else { state.lost.saturating_add(1) };
        if self.blind(state) {
            return;
        }
        if was_blind {
            state.periodic_disturbance = PeriodicDisturbanceState::default();
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

    /// Stores the commanded pulls, N, without their friction feed-forward.
    pub fn commanded(&self, state: &mut StateFeedbackState, pulls: &Vector4<f64>, against_friction: &Vector4<f64>) {
        state.acting = pulls - against_friction;
    }

    /// Notes that the reference does not move: its jerk is zero.
    pub fn idle(&self, state: &mut StateFeedbackState) {
        state.jerk = Vector3::zeros();
    }

    /// Returns the joint angles of the reference, rad, and their motion.
    pub fn reference(&self, state: &StateFeedbackState) -> (Vector3<f64>, Motion) {
        let ReferenceMotion { joints, rates, accelerations, jerk, snap } = self.reference.motion(&state.reference);
        (joints, Motion { rates, accelerations, jerk, snap })
    }

    fn motion(&self, state: &StateFeedbackState, tendon: usize) -> TendonMotion {
        self.observers[tendon].motion(&state.estimates[tendon], state.acting[tendon], self.sample_offset)
    }

    /// Returns theta, rad.
    fn pose(&self, estimates: &[TendonEstimate; 4]) -> Vector3<f64> {
        let travel = Vector4::from_fn(|tendon, _| self.observers[tendon].travel(&estimates[tendon]));
        self.pseudo_inverse.tr_mul(&travel)
    }

    /// Returns the travel of the motors, m.
    fn travel(&self, measured: &Measured) -> Vector4<f64> {
        (measured.motor_angles + self.half_count).component_mul(&self.radius)
    }
}
