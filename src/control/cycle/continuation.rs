//! How a controller begins when there is a state already: it continues the state of another controller, or it starts
//! anew after the motors were off or replies were lost.

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
        if let (Some(law), Some(old), Some(law_state)) =
            (&self.state_feedback, &previous.state_feedback, &mut state.state_feedback)
        {
            law.take_over(old, law_state);
        }
        // The contact estimate has learned the error of the torques that `previous` computes. A controller that
        // computes other torques must learn again. Otherwise the difference of the torques would count as a contact.
        // Nothing is learned during a contact, so this contact would never end.
        let weight = |controller: &Self| controller.gravity.weight(&state.gravity, &state.report.joints);
        let same_torques = self.contact.has_arms_of(&previous.contact) && self.sensors == previous.sensors;
        if !same_torques || weight(self) != weight(previous) {
            self.contact.end(&mut state.contact, &mut state.report);
        }
        self.cycle(state, feedback, activity)
    }

    /// Notes that a path begins in the next cycle. `set_point` is the set point of the next cycle. If the path differs
    /// from the motion of the set point until now, the reference of state feedback reaches the path through the filter
    /// that smooths steps.
    pub fn begin_path(&self, state: &mut State, set_point: &SetPoint) {
        if let (Some(law), Some(law_state), Some(motion)) =
            (&self.state_feedback, &mut state.state_feedback, &set_point.motion)
        {
            law.begin_path(law_state, &set_point.joints, motion);
        }
    }

    /// Returns the state in which the finger starts anew from this feedback. Only the heat of the motors is kept,
    /// because windings do not cool when a controller restarts.
    pub fn start_anew(&self, state: &State, feedback: &Feedback) -> State {
        State { heat: state.heat.if_finite(), ..self.start(feedback) }
    }

    /// Lowers the heat of motors that have had no torque for `time`, s.
    pub fn cool(&self, state: &mut State, time: f64) {
        self.heating.cool(&mut state.heat, time);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::configuration::{ConfiguredFinger, Scheme};
    use nalgebra::{Matrix3, Vector3};

    /// Returns whether a finger counts as touching something 1 s after an adjustment. Its sensors show constant values,
    /// except that the tension of tendon 1 rises once before the adjustment if the finger is `pushed`.
    fn touches_after(change: fn(&mut ConfiguredFinger), pushed: bool) -> bool {
        let mut finger = ConfiguredFinger::default();
        finger.controller.scheme = Some(Scheme::Figure10);
        let before = Controller::new(&finger, 1000.0).expect("usable");
        change(&mut finger);
        let after = Controller::new(&finger, 1000.0).expect("usable");
        // The joint angles are about 0, 0.5 and 0.8 rad, and the tensions are along the null vector of R.
        let free = Feedback { motor_counts: [3652, 5401, -5401, -3652], gauge_counts: [205, 360, 360, 205] };
        let now = if pushed { Feedback { gauge_counts: [305, 360, 360, 205], ..free } } else { free };
        let joints = Vector3::new(0.0, 0.5, 0.8);
        let activity = Activity::Follow(SetPoint::hard_finger(joints, Matrix3::identity() * 3.0));
        let mut state = before.start(&free);
        for cycle in 0..1200 {
            let feedback = if cycle < 1000 { free } else { now };
            before.cycle(&mut state, Some(&feedback), &activity);
        }
        assert_eq!(state.report.contact.touching, pushed);
        after.take_over(&before, &mut state, Some(&now), &activity);
        for _ in 0..1000 {
            after.cycle(&mut state, Some(&now), &activity);
        }
        state.report.contact.touching
    }

    #[test]
    fn an_adjustment_of_moment_arms_or_gauges_is_no_contact() {
        assert!(!touches_after(|finger| finger.geometry.r.iter_mut().for_each(|joint| joint[0] *= 1.1), false));
        assert!(!touches_after(|finger| finger.gauge.zero[0] = 100.0, false));
    }

    #[test]
    fn a_contact_lasts_over_an_adjustment_of_something_else() {
        assert!(touches_after(|finger| finger.tendon.minimum = 6.0, true));
    }
}
