//! One servo cycle: the boxes of Figure 9 connected, or state feedback in the place of most of them.

use super::admissible_stiffness::AdmissibleStiffness;
use super::gains::Gains;
use super::gravity_compensation::GravityCompensation;
use super::joint_positions::JointPositions;
use super::joint_stiffness::JointStiffness;
use super::low_pass::LowPass;
use super::monitors::{Alarms, Monitors, Watch};
use super::motor_heating::{Heat, MotorHeating};
use super::motor_torque::MotorTorque;
use super::release::Release;
use super::sensors::Sensors;
use super::signals::{Activity, Command, Feedback, Measured, Report, SetPoint};
use super::slack::{Slack, SlackTakeUp, Slackness, TakeUp};
use super::slew::Slew;
use super::soft_limits::SoftLimits;
use super::spring_transition::{Spring, SpringStages, SpringTransition};
use super::state_feedback::{Decision, StateFeedback, StateFeedbackState};
use super::stillness::Stillness;
use super::tendon_controller::TendonController;
use super::tension_distribution::{Distribution, TensionDistribution};
use super::tension_integral::{TendonInput, TendonState};
use super::transition::Transition;
use super::usable::positive;
use crate::model::configuration::{ConfiguredFinger, Scheme, Unusable};
use nalgebra::{Matrix3, Vector3, Vector4};
use serde::{Deserialize, Serialize};

/// A tendon counts as tight from this part of t_min on.
const TIGHT: f64 = 0.8;

/// Damping over stiffness of the soft limits with the figures of the report, s.
const LIMIT_DAMPING: f64 = 0.015;

/// Below this part of its desired tension a tendon counts as slack while slack is taken up: well under what a motor with
/// the friction and the error of its torque constant reaches without the integral.
const SLACK: f64 = 0.2;

/// Everything about a finger's servo that does not change from cycle to cycle.
#[derive(Clone, Debug)]
pub struct Controller {
    period: f64,
    sensors: Sensors,
    speed_filter: LowPass,
    stretch_filter: LowPass,
    joint_positions: JointPositions,
    slack: SlackTakeUp,
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
    monitors: Monitors,
    /// Motor radii, m.
    radius: Vector4<f64>,
    /// N.
    tight: f64,
}

/// What a cycle leaves behind for the next one.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub struct State {
    doing: Doing,
    motor_angles: Vector4<f64>,
    /// Cycles since `motor_angles` were measured.
    age: u32,
    /// Low-passed, rad/s.
    motor_speeds: Vector4<f64>,
    /// Low-passed, N, for the tendon stretch.
    tensions: Vector4<f64>,
    tendons: TendonState,
    transition: Transition,
    /// The spring that is followed.
    spring: Option<SpringStages>,
    /// What the controller before this one would pull next, N at the tendon.
    goes_on_from: Option<Vector4<f64>>,
    stillness: Stillness,
    /// N at the tendon.
    pulls: Vector4<f64>,
    /// The pulls that act until the next sample: one cycle older.
    acting: Vector4<f64>,
    /// The part of `pulls` that is fed forward against friction.
    against_friction: Vector4<f64>,
    state_feedback: Option<StateFeedbackState>,
    heat: Heat,
    report: Report,
}

/// The activity of the last cycle, with what belongs to it.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
enum Doing {
    Nothing,
    TakingUpSlack(Slack),
    /// With the spring's anchor on its way to the set point, rad.
    Following(Vector3<f64>),
    Releasing(Release),
    Tensing,
    PullingFreely,
}

impl Controller {
    /// The controller of `finger` at `rate` cycles a second. Gains that are not configured come from the nearest of 500,
    /// 1000 and 2000 Hz. Refused with the key that cannot be used, where the numbers make no controller.
    pub fn new(finger: &ConfiguredFinger, rate: f64) -> Result<Self, Unusable> {
        Self::in_gravity(finger, &Vector3::zeros(), rate)
    }

    /// The same with gravity, m/s^2 in the finger's frame, to be compensated.
    pub fn in_gravity(finger: &ConfiguredFinger, gravity: &Vector3<f64>, rate: f64) -> Result<Self, Unusable> {
        positive("rate", &[rate])?;
        let tendons = finger.tendons().map_err(|error| Unusable { key: "geometry.r", reason: error.to_string() })?;
        let gains = Gains::new(&finger.controller, rate)?;
        let motor_torque = MotorTorque::new(finger, &tendons)?;
        // A tendon is pulled no harder than its motor can: clamping there would turn the joint torque.
        let strongest = motor_torque.limit.map(|limit| limit.min(finger.tendon.maximum));
        let scheme = finger.controller.scheme(rate);
        let state_feedback = match scheme {
            Scheme::StateFeedback => Some(StateFeedback::new(finger, &tendons, gains.set_point_speed, rate)?),
            Scheme::Figure9 | Scheme::Figure10 | Scheme::Figure11 => None,
        };
        // What shakes the tensions shall stay within their bounds.
        let reserve = state_feedback.as_ref().map_or(0.0, |law| law.reserve);
        positive("motor.continuous_torque", &finger.motor.continuous_torque)?;
        positive("motor.thermal_time", &[finger.motor.thermal_time])?;
        let soft = || Unusable { key: "tendon.stiffness", reason: "does not hold every joint".into() };
        Ok(Self {
            admissible: AdmissibleStiffness::new(finger, &tendons, rate).ok_or_else(soft)?,
            spring_transition: SpringTransition::new(rate),
            soft_limits: SoftLimits::new(finger),
            gravity: GravityCompensation::new(finger, gravity),
            heating: MotorHeating::new(finger, motor_torque.limit, &tendons.radius, rate),
            monitors: Monitors::new(finger, &tendons, rate)?,
            period: 1.0 / rate,
            sensors: Sensors::new(finger)?,
            speed_filter: LowPass::new(gains.speed_filter, rate),
            stretch_filter: LowPass::new(gains.stretch_filter, rate),
            joint_positions: JointPositions::new(finger, &tendons)?,
            slack: SlackTakeUp::new(finger.links(), &tendons, finger.tendon.minimum, rate),
            slew: Slew::new(gains.set_point_speed, rate),
            joint_stiffness: JointStiffness::new(finger.links(), gains.rate_time),
            distribution: TensionDistribution::new(
                &tendons,
                finger.tendon.minimum + reserve,
                strongest.add_scalar(-reserve),
            )?,
            tendons: TendonController::new(scheme, &gains, rate),
            motor_torque,
            motor_damping: gains.motor_damping,
            state_feedback,
            radius: tendons.radius * 0.01,
            tight: TIGHT * finger.tendon.minimum,
        })
    }

    /// The state before the first cycle of a finger at rest. Its first command will pull as much as the tendons do.
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
            transition: Transition::default(),
            spring: None,
            goes_on_from: None,
            stillness: Stillness::new(motor_angles),
            pulls,
            acting: pulls,
            against_friction: Vector4::zeros(),
            state_feedback: self.state_feedback.as_ref().map(|law| law.start(&measured)),
            heat: Heat::default(),
            report,
        }
    }

    /// One cycle that goes on from the state of another controller of the same finger, with the same encoders and at the same
    /// rate, without a jump in torque.
    ///
    /// It goes on from what `previous` would command in this very cycle, and not from its last command: so a planner that adjusts
    /// in every cycle neither stops the feedback nor delays it.
    pub fn take_over(
        &self,
        previous: &Self,
        state: &mut State,
        feedback: Option<&Feedback>,
        activity: &Activity,
    ) -> (Command, Report) {
        let mut before = *state;
        previous.cycle(&mut before, feedback, activity);
        state.goes_on_from = Some(before.pulls);
        if let (Some(law), Some(old), Some(elastic)) =
            (&self.state_feedback, &previous.state_feedback, &mut state.state_feedback)
        {
            law.take_over(old, elastic);
        }
        self.cycle(state, feedback, activity)
    }

    /// One cycle. Without feedback (the reply was lost) the last command is repeated and everything that integrates rests,
    /// but a release goes on, and so does state feedback for some cycles, from what it predicts.
    pub fn cycle(&self, state: &mut State, feedback: Option<&Feedback>, activity: &Activity) -> (Command, Report) {
        let measured = feedback.map(|feedback| self.sensors.measured(feedback));
        self.cycle_measured(state, measured.as_ref(), activity)
    }

    /// [`Controller::cycle`] from the sensors' values instead of their counts, so without quantisation: the smooth map that a
    /// linear analysis needs.
    pub fn cycle_measured(
        &self,
        state: &mut State,
        measured: Option<&Measured>,
        activity: &Activity,
    ) -> (Command, Report) {
        state.age = state.age.saturating_add(1);
        let acting = state.pulls;
        if let Some(measured) = measured {
            self.measure(state, measured);
        }
        let observed = self.observe(state, measured);
        if !matches!(activity, Activity::Follow(_)) {
            state.against_friction = Vector4::zeros();
            state.spring = None;
            if let (Some(law), Some(elastic)) = (&self.state_feedback, &mut state.state_feedback) {
                law.idle(elastic);
            }
        }
        match activity {
            &Activity::Release { ramp } => self.let_go(state, ramp),
            Activity::Follow(set_point) if observed => self.follow_by_state(state, set_point),
            Activity::TakeUpSlack if measured.is_some() => {
                let gravity = self.gravity.torques(&state.report.joints);
                self.take_up_slack(state, &Vector4::zeros(), gravity);
            }
            Activity::Tighten(offset) if measured.is_some() => self.take_up_slack(state, offset, Vector3::zeros()),
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
        if let (Some(law), Some(elastic)) = (&self.state_feedback, &mut state.state_feedback) {
            law.commanded(elastic, &state.pulls, &state.against_friction);
        }
        state.acting = acting;
        self.heating.advance(&mut state.heat, &state.pulls);
        let motor_torques = self.motor_torque.torques(&state.pulls);
        state.report.motor_torques = motor_torques;
        (Command { motor_torques }, state.report)
    }

    /// What is wrong with a finger that follows, after a cycle with `feedback`, `age` periods after the one before. `full_scale`: the
    /// gauges' largest count.
    pub fn watch(&self, watch: &mut Watch, state: &State, feedback: &Feedback, age: f64, full_scale: u16) -> Alarms {
        let heat = self.heating.part(&state.heat);
        self.monitors.watch(watch, feedback, &state.report, &state.pulls, &heat, age, full_scale)
    }

    /// The part of a spring's K_theta, N cm/rad, that the pose can carry.
    fn carried(&self, report: &mut Report, k_theta: &Matrix3<f64>) -> f64 {
        report.stiffness_scale = self.admissible.scale(k_theta);
        report.stiffness_scale
    }

    /// Keeps the observers of state feedback going in every activity; whether it can decide.
    fn observe(&self, state: &mut State, measured: Option<&Measured>) -> bool {
        let Some(law) = &self.state_feedback else {
            state.state_feedback = None;
            return false;
        };
        let Some(elastic) = &mut state.state_feedback else {
            // Another scheme was in charge until now.
            state.state_feedback = measured.map(|measured| law.start(measured));
            return state.state_feedback.is_some();
        };
        law.observe(elastic, measured);
        state.report.joints = elastic.joints;
        state.report.joint_rates = elastic.joint_rates;
        !law.blind(elastic)
    }

    /// Motor angles and tensions to joint angles and rates.
    fn measure(&self, state: &mut State, measured: &Measured) {
        let Measured { motor_angles, tensions } = *measured;
        let elapsed = self.period * f64::from(state.age);
        let speeds = (motor_angles - state.motor_angles) / elapsed;
        self.speed_filter.advance(&mut state.motor_speeds, &speeds);
        self.stretch_filter.advance(&mut state.tensions, &tensions);
        state.stillness.note(&motor_angles, elapsed);
        state.motor_angles = motor_angles;
        state.age = 0;

        let report = &mut state.report;
        report.joints = self.joint_positions.joints(&motor_angles, &state.tensions);
        report.joint_rates = self.joint_positions.joint_rates(&state.motor_speeds);
        report.tensions = tensions;
        report.under_tension = tensions.min() >= self.tight && state.stillness.at_rest();
    }

    /// Pretension, with the joints held where they are when the last tendon comes taut. `offset`: what the gauges show too much, N;
    /// `gravity`: what holds the links there, N cm.
    fn take_up_slack(&self, state: &mut State, offset: &Vector4<f64>, gravity: Vector3<f64>) {
        let now = Slackness {
            travel: state.motor_angles.component_mul(&self.radius),
            speeds: state.motor_speeds.component_mul(&self.radius),
            tensions: state.report.tensions - offset,
            // Not what state feedback observes: this is Figures 9 and 10, which need the stretch low-passed.
            joints: self.joint_positions.joints(&state.motor_angles, &state.tensions),
            joint_rates: self.joint_positions.joint_rates(&state.motor_speeds),
        };
        let (mut slack, starts) = match state.doing {
            Doing::TakingUpSlack(slack) => (slack, false),
            _ => (self.slack.start(&now), true),
        };
        state.report.slackest = self.slack.slackest(&slack, &now);
        match self.slack.step(&mut slack, &now) {
            TakeUp::Pull(pulls) => {
                self.give(state, &pulls, starts);
                // Whatever follows begins anew.
                state.tendons = TendonState::default();
                state.report.joint_torques = Vector3::zeros();
                state.report.desired_tensions = pulls;
                state.report.torque_scale = 1.0;
            }
            TakeUp::Hold { torques, below, begins } => {
                let torques = torques + gravity;
                let Distribution { tensions, scale } = self.distribution.distribute(&torques);
                self.bring(state, tensions - below + offset, begins);
                state.report.joint_torques = torques;
                state.report.torque_scale = scale;
                state.report.under_tension &= below == Vector4::zeros();
            }
        }
        state.doing = Doing::TakingUpSlack(slack);
    }

    /// The spring, from its anchor to the joints. It begins without deflection.
    fn follow(&self, state: &mut State, set_point: &SetPoint) {
        let spring = self.spring_transition.advance(&mut state.spring, set_point);
        let mut spring = self.joint_stiffness.posed(spring, &state.report.joints);
        spring.soften(self.carried(&mut state.report, &spring.k_theta));
        let (mut anchor, begins) = match state.doing {
            Doing::Following(anchor) => (anchor, false),
            _ => (state.report.joints, true),
        };
        self.slew.advance(&mut anchor, &set_point.joints);
        state.doing = Doing::Following(anchor);
        let Report { joints, joint_rates, .. } = &state.report;
        let torques = spring.torques(&anchor) - spring.damper(joint_rates);
        let push = self.soft_limits.push(joints);
        let damped = push.stiffness.component_mul(joint_rates) * LIMIT_DAMPING;
        let torques = torques + push.torque - damped + self.gravity.torques(joints);
        let Distribution { tensions: desired, scale } = self.distribution.distribute(&torques);
        self.bring(state, desired, begins);
        state.report.joint_torques = torques;
        state.report.torque_scale = scale;
    }

    /// The spring by state feedback. It begins without deflection.
    fn follow_by_state(&self, state: &mut State, set_point: &SetPoint) {
        let spring = self.spring_transition.advance(&mut state.spring, set_point);
        let k_theta = self.joint_stiffness.joint_stiffness(spring, &state.report.joints);
        let scale = self.carried(&mut state.report, &k_theta);
        let spring = &Spring { stiffness: spring.stiffness * scale, ..*spring };
        let (Some(law), Some(elastic)) = (&self.state_feedback, &mut state.state_feedback) else {
            return;
        };
        let begins = !matches!(state.doing, Doing::Following(_));
        state.doing = Doing::Following(elastic.joints);
        let Decision { pulls, against_friction, joint_torques, distribution } =
            law.decide(elastic, spring, begins, &self.soft_limits, &self.gravity, &self.distribution);
        state.against_friction = against_friction;
        self.give(state, &pulls, false);
        state.report.joint_torques = joint_torques;
        state.report.desired_tensions = distribution.tensions;
        state.report.torque_scale = distribution.scale;
    }

    /// Tensions as they are asked for.
    fn tense(&self, state: &mut State, desired: Vector4<f64>) {
        let begins = !matches!(state.doing, Doing::Tensing);
        state.doing = Doing::Tensing;
        self.bring(state, desired, begins);
        state.report.joint_torques = Vector3::zeros();
        state.report.torque_scale = 1.0;
    }

    /// Pulls without tension feedback.
    fn pull_freely(&self, state: &mut State, pulls: Vector4<f64>) {
        let speed = state.motor_speeds.component_mul(&self.radius);
        self.pull_with(state, pulls - speed * self.motor_damping);
    }

    /// Motor torques without any feedback.
    fn turn(&self, state: &mut State, torques: Vector4<f64>) {
        self.pull_with(state, self.motor_torque.pulls(&torques));
    }

    fn pull_with(&self, state: &mut State, pulls: Vector4<f64>) {
        let limit = &self.motor_torque.limit;
        state.pulls = pulls.zip_map(limit, |pull, limit| pull.clamp(-limit, limit));
        state.doing = Doing::PullingFreely;
        // Whatever follows begins anew.
        state.tendons = TendonState::default();
        state.report.joint_torques = Vector3::zeros();
        state.report.desired_tensions = state.pulls;
        state.report.torque_scale = 1.0;
    }

    /// Desired tensions to pulls: the tendon controller.
    fn bring(&self, state: &mut State, desired: Vector4<f64>, begins: bool) {
        let measured = state.report.tensions;
        let following = matches!(state.doing, Doing::Following(_));
        let slack = std::array::from_fn(|tendon| !following && measured[tendon] < SLACK * desired[tendon]);
        let speed = state.motor_speeds.component_mul(&self.radius);
        let (limit, acted) = (self.heating.limit(&state.heat), state.acting);
        let input = TendonInput { desired, measured, speed, slack, limit, acted };
        let asked = self.tendons.pulls(&mut state.tendons, &input);
        self.give(state, &asked, begins);
        state.report.desired_tensions = desired;
    }

    /// Pulls to the motors: without a jump where something begins, and within their limits.
    fn give(&self, state: &mut State, asked: &Vector4<f64>, begins: bool) {
        let goes_on_from = state.goes_on_from.take();
        if let Some(before) = goes_on_from.or(begins.then_some(state.pulls)) {
            state.transition.begin(&before, asked);
        }
        let limit = &self.heating.limit(&state.heat);
        let pulls = asked + state.transition.advance(self.period);
        state.pulls = pulls.zip_map(limit, |pull, limit| pull.clamp(-limit, limit));
    }

    /// Motor torques in a ramp to zero.
    fn let_go(&self, state: &mut State, ramp: f64) {
        let mut release = match state.doing {
            Doing::Releasing(release) => release,
            _ => Release::new(state.pulls),
        };
        state.pulls = release.advance(self.period, ramp);
        state.doing = Doing::Releasing(release);
        // Whatever follows begins anew.
        state.tendons = TendonState::default();
        state.report.joint_torques = Vector3::zeros();
        state.report.desired_tensions = state.pulls;
        state.report.torque_scale = 1.0;
    }
}
