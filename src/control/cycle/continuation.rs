//! Starts from an earlier state: continues it with another controller, or starts anew after the motors were off or
//! replies were lost.

use super::{Controller, Doing, State};
use crate::control::signals::{Activity, Feedback, MotorCommand, Report, SetPoint};

impl Controller {
    /// Runs one cycle that continues without a jump in torque from the state of `previous`, another controller of the
    /// same finger. Both controllers have the same encoders and the same rate.
    ///
    /// The cycle starts from the command that `previous` would compute in this cycle, and not from the last command of
    /// `previous`. A planner that adjusts the controller in every cycle therefore neither stops the feedback nor delays
    /// it.
    pub fn take_over(
        &self,
        previous: &Self,
        state: &mut State,
        feedback: Option<&Feedback>,
        activity: &Activity,
    ) -> (MotorCommand, Report) {
        let mut before = *state;
        previous.cycle(&mut before, feedback, activity);
        // The state stores pulls at the tendons. If the motor radius differs, the pulls are scaled so that the motor
        // torques stay the same.
        let ratio = previous.radius.component_div(&self.radius);
        state.goes_on_from = Some(before.pulls.component_mul(&ratio));
        for pulls in [&mut state.pulls, &mut state.acting, &mut state.against_friction] {
            pulls.component_mul_assign(&ratio);
        }
        state.heat.scale(&ratio);
        match &mut state.doing {
            Doing::TakingUpSlack(slack) => slack.change_radius(&ratio),
            Doing::Releasing(release) => release.scale(&ratio),
            _ => {}
        }
        if let (Some(law), Some(old), Some(elastic)) =
            (&self.state_feedback, &previous.state_feedback, &mut state.state_feedback)
        {
            law.take_over(old, elastic);
        }
        self.cycle(state, feedback, activity)
    }

    /// Notes that a path begins in the next cycle. The path may differ from the motion of the set point until now. The
    /// reference then reaches the path through the filter that smooths steps. `set_point` is the set point of that
    /// cycle.
    pub fn begin_path(&self, state: &mut State, set_point: &SetPoint) {
        if let (Some(law), Some(elastic), Some(motion)) =
            (&self.state_feedback, &mut state.state_feedback, &set_point.motion)
        {
            law.begin_path(elastic, &set_point.joints, motion);
        }
    }

    /// Returns the state in which the finger starts anew from this feedback. Only the heat of the motors is kept,
    /// because windings do not cool when a controller restarts.
    pub fn start_anew(&self, state: &State, feedback: &Feedback) -> State {
        State { heat: state.heat.if_finite(), ..self.start(feedback) }
    }

    /// Cools the motors of a finger whose motors have had no torque for a time, s.
    pub fn cool(&self, state: &mut State, time: f64) {
        self.heating.cool(&mut state.heat, time);
    }
}
