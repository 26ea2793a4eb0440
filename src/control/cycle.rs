//! One servo cycle. It connects the blocks of Figure 9 of the report, or it uses state feedback, which replaces most of
//! these blocks.

mod construction;
mod continuation;
mod pretension;
mod pulls;
mod spring;

use crate::control::contact::{ContactObserver, ContactState};
use crate::control::monitors::{Alarms, Monitors, Watch};
use crate::control::motion::Motion;
use crate::control::motors::{motor_heating::Heat, motor_heating::MotorHeating, motor_torque::MotorTorque};
use crate::control::sensing::{joint_positions::JointPositions, sensors::SensorScales, stillness::Stillness};
use crate::control::signals::{Activity, Feedback, Measured, MotorCommand, Report, SetPoint};
use crate::control::spring::admissible_stiffness::AdmissibleStiffness;
use crate::control::spring::gravity_compensation::GravityCompensation;
use crate::control::spring::joint_stiffness::JointStiffness;
use crate::control::spring::slew::Slew;
use crate::control::spring::soft_limits::SoftLimits;
use crate::control::spring::spring_transition::{SpringStages, SpringTransition};
use crate::control::state_feedback::{StateFeedback, StateFeedbackState};
use crate::control::take_up::progress::Slack;
use crate::control::take_up::slack::SlackTakeUp;
use crate::control::take_up::tightening::{Tightening, TighteningState};
use crate::control::tendons::bumpless_transfer::BumplessTransfer;
use crate::control::tendons::low_pass::LowPass;
use crate::control::tendons::release::Release;
use crate::control::tendons::tendon_controller::TendonController;
use crate::control::tendons::tension_distribution::TensionDistribution;
use crate::control::tendons::tension_integral::TendonState;
use nalgebra::{Vector3, Vector4};
use serde::{Deserialize, Serialize};

/// The constant part of a finger's servo: everything that does not change from cycle to cycle.
#[derive(Clone, Debug)]
pub struct Controller {
    period: f64,
    sensors: SensorScales,
    speed_filter: LowPass,
    stretch_filter: LowPass,
    joint_positions: JointPositions,
    slack: SlackTakeUp,
    tightening: Tightening,
    slew: Slew,
    joint_stiffness: JointStiffness,
    distribution: TensionDistribution,
    tendons: TendonController,
    motor_torque: MotorTorque,
    /// K_delta at the tendon, N s/m.
    motor_damping: f64,
    state_feedback: Option<StateFeedback>,
    admissible: AdmissibleStiffness,
    spring_transition: SpringTransition,
    soft_limits: SoftLimits,
    gravity: GravityCompensation,
    heating: MotorHeating,
    contact: ContactObserver,
    monitors: Monitors,
    /// Motor radii, m.
    radius: Vector4<f64>,
    /// Lowest tension at which a tendon is considered to be tight, N.
    tight: f64,
}

/// The part of a finger's servo that changes from cycle to cycle.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub struct State {
    doing: Doing,
    motor_angles: Vector4<f64>,
    /// Cycles since `motor_angles` were measured.
    age: u32,
    /// Low-pass filtered motor speeds, rad/s.
    motor_speeds: Vector4<f64>,
    /// Low-pass filtered tensions, N, for the stretch of the tendons.
    tensions: Vector4<f64>,
    tendons: TendonState,
    transition: BumplessTransfer,
    /// The spring that the finger follows.
    spring: Option<SpringStages>,
    /// Pulls at the tendons that the previous controller would command in this cycle, N. Set only in the cycle in which
    /// one controller takes over from another.
    goes_on_from: Option<Vector4<f64>>,
    stillness: Stillness,
    /// Commanded pulls at the tendons, N.
    pulls: Vector4<f64>,
    /// The pulls that the previous cycle commanded, N. They act until the next sample.
    acting: Vector4<f64>,
    /// The part of `pulls` that is friction feed-forward, N.
    against_friction: Vector4<f64>,
    state_feedback: Option<StateFeedbackState>,
    heat: Heat,
    contact: ContactState,
    /// Gravity in the finger's frame, m/s^2, if it was set after the controller was constructed.
    #[serde(default)]
    gravity: Option<Vector3<f64>>,
    report: Report,
}

/// The activity of the last cycle, with the state that belongs to it.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[expect(clippy::large_enum_variant, reason = "a box would be allocated and freed in the servo")]
enum Doing {
    Nothing,
    TakingUpSlack(Slack),
    Tightening(TighteningState),
    /// With Figures 9, 10 and 11, the field is the anchor of the spring, rad. The anchor moves toward the set point at
    /// a limited speed. With state feedback, the field contains the estimated joint angles, rad.
    Following(Vector3<f64>),
    Releasing(Release),
    Tensing,
    PullingFreely,
}

impl Controller {
    /// Returns the state before the first cycle of a finger at rest. The commanded pulls start at the measured
    /// tensions.
    pub fn start(&self, feedback: &Feedback) -> State {
        let measured = self.sensors.measured(feedback);
        let Measured { motor_angles, tensions } = measured;
        let limit = &self.motor_torque.limit;
        let pulls = tensions.zip_map(limit, |tension, limit| tension.clamp(0.0, limit));
        let report = Report {
            joints: self.joint_positions.joints(&motor_angles, &tensions),
            tensions,
            torque_scale: 1.0,
            stiffness_scale: 1.0,
            ..Report::default()
        };
        State {
            doing: Doing::Nothing,
            motor_angles,
            age: 0,
            motor_speeds: Vector4::zeros(),
            tensions,
            tendons: TendonState::default(),
            transition: BumplessTransfer::default(),
            spring: None,
            goes_on_from: None,
            stillness: Stillness::new(motor_angles),
            pulls,
            acting: pulls,
            against_friction: Vector4::zeros(),
            state_feedback: self.state_feedback.as_ref().map(|law| law.start(&measured)),
            heat: Heat::default(),
            contact: ContactState::default(),
            gravity: None,
            report,
        }
    }

    /// Sets the gravity that the next cycles compensate, m/s^2 in the finger's frame. This value is an input of every
    /// cycle, like the set point: a hand on a moving arm changes it all the time. A large change is spread over some
    /// cycles, so that it causes no jump in torque. The first value after a start takes effect at once.
    pub fn approach_gravity(&self, state: &mut State, gravity: &Vector3<f64>) {
        self.gravity.approach(&mut state.gravity, gravity);
    }

    /// Runs one cycle. Without feedback (the reply was lost), the last command is repeated and all integrators keep
    /// their values. A release and [`Activity::Turn`] continue without feedback. State feedback continues for some
    /// cycles with its predictions.
    pub fn cycle(&self, state: &mut State, feedback: Option<&Feedback>, activity: &Activity) -> (MotorCommand, Report) {
        let measured = feedback.map(|feedback| self.sensors.measured(feedback));
        self.cycle_measured(state, measured.as_ref(), activity)
    }

    /// Runs [`Controller::cycle`] with sensor values in physical units instead of counts. Without quantisation the
    /// cycle is a smooth map, as a linear analysis requires.
    pub fn cycle_measured(
        &self,
        state: &mut State,
        measured: Option<&Measured>,
        activity: &Activity,
    ) -> (MotorCommand, Report) {
        state.age = state.age.saturating_add(1);
        let acting = state.pulls;
        let elapsed = self.period * f64::from(state.age);
        if let Some(measured) = measured {
            self.measure(state, measured, elapsed);
        }
        let observed = self.observe(state, measured);
        if matches!(activity, Activity::Follow(_)) {
            if measured.is_some() {
                let weight = |joints: &Vector3<f64>| self.gravity.weight(&state.gravity, joints);
                self.contact.follow(&mut state.contact, &mut state.report, weight, elapsed);
            }
        } else {
            self.contact.end(&mut state.contact, &mut state.report);
            state.against_friction = Vector4::zeros();
            state.spring = None;
            if let (Some(law), Some(law_state)) = (&self.state_feedback, &mut state.state_feedback) {
                law.idle(law_state);
            }
        }
        match activity {
            &Activity::Release { ramp } => self.release(state, ramp),
            Activity::Follow(set_point) if observed => self.follow_by_state(state, set_point),
            Activity::TakeUpSlack if measured.is_some() => self.take_up_slack(state),
            Activity::Tighten(offset) if measured.is_some() => self.tighten(state, offset),
            Activity::Follow(set_point) if measured.is_some() => self.follow(state, set_point),
            &Activity::Tense(desired) if measured.is_some() => self.tense(state, desired),
            &Activity::Pull(pulls) if measured.is_some() => self.pull_freely(state, pulls),
            &Activity::Turn(torques) => self.turn(state, torques),
            Activity::TakeUpSlack
            | Activity::Tighten(_)
            | Activity::Follow(_)
            | Activity::Tense(_)
            | Activity::Pull(_) => {}
        }
        if let (Some(law), Some(law_state)) = (&self.state_feedback, &mut state.state_feedback) {
            law.commanded(law_state, &state.pulls, &state.against_friction);
        }
        state.acting = acting;
        self.heating.advance(&mut state.heat, &state.pulls);
        let motor_torques = self.motor_torque.torques(&state.pulls);
        state.report.motor_torques = motor_torques;
        (MotorCommand { motor_torques }, state.report)
    }

    /// Runs the monitors after a cycle with `feedback`, for a finger that follows a set point. `age` is the number of
    /// periods since the previous sample, and `full_scale` the largest count of the gauges.
    pub fn watch(&self, watch: &mut Watch, state: &State, feedback: &Feedback, age: f64, full_scale: u16) -> Alarms {
        let heat = self.heating.part(&state.heat);
        // The cycle has already converted the counts to physical units.
        let measured = Measured { motor_angles: state.motor_angles, tensions: state.report.tensions };
        self.monitors.watch(watch, feedback, &measured, &state.report, &state.pulls, &heat, age, full_scale)
    }

    /// Returns the distribution of joint torques to tensions within their bounds.
    pub fn distribution(&self) -> &TensionDistribution {
        &self.distribution
    }

    /// Returns the joint angles, rad, that the controller follows, and their motion. `set_point` is the set point of
    /// the last cycle. While the finger does not follow a set point, the result is the measured pose without motion.
    pub fn reference(&self, state: &State, set_point: &SetPoint) -> (Vector3<f64>, Motion) {
        match (&self.state_feedback, &state.state_feedback, &state.doing) {
            (Some(law), Some(law_state), Doing::Following(_)) => law.reference(law_state),
            (None, _, Doing::Following(anchor)) => {
                let mut motion = set_point.motion.unwrap_or_default();
                // An anchor that has not reached the set point also moves relative to it.
                motion.rates += self.slew.next_step(anchor, &set_point.joints) / self.period;
                (*anchor, motion)
            }
            _ => (state.report.joints, Motion::default()),
        }
    }

    /// Updates the observers of state feedback, in every activity. Returns whether state feedback can compute a
    /// command.
    fn observe(&self, state: &mut State, measured: Option<&Measured>) -> bool {
        let Some(law) = &self.state_feedback else {
            state.state_feedback = None;
            return false;
        };
        let Some(law_state) = &mut state.state_feedback else {
            // A controller with another scheme was active until now.
            state.state_feedback = measured.map(|measured| law.start(measured));
            return state.state_feedback.is_some();
        };
        law.observe(law_state, measured);
        state.report.joints = law_state.joints;
        state.report.joint_rates = law_state.joint_rates;
        !law.blind(law_state)
    }

    /// Converts motor angles and tensions to joint angles and rates. `elapsed` is the time since the previous sample,
    /// s.
    fn measure(&self, state: &mut State, measured: &Measured, elapsed: f64) {
        let Measured { motor_angles, tensions } = *measured;
        let speeds = (motor_angles - state.motor_angles) / elapsed;
        self.speed_filter.advance(&mut state.motor_speeds, &speeds);
        self.stretch_filter.advance(&mut state.tensions, &tensions);
        state.stillness.note(&motor_angles, elapsed);
        state.motor_angles = motor_angles;
        state.age = 0;

        let report = &mut state.report;
        // State feedback observes the joints itself.
        if self.state_feedback.is_none() || state.state_feedback.is_none() {
            report.joints = self.joint_positions.joints(&motor_angles, &state.tensions);
            report.joint_rates = self.joint_positions.joint_rates(&state.motor_speeds);
        }
        report.tensions = tensions;
        report.under_tension = tensions.min() >= self.tight && state.stillness.at_rest();
    }
}
