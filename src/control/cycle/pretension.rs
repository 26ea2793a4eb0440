//! Takes up slack: brings every tendon under tension and holds the joints where they are.

use super::pulls::open_loop;
use super::{Controller, Doing, State};
use crate::control::take_up::progress::Slackness;
use crate::control::take_up::tightening::{Joints, Tightened};
use crate::control::tendons::tension_distribution::DistributedTensions;
use nalgebra::Vector4;

impl Controller {
    /// Runs one cycle of taking up slack. The motors hold the joints where they are.
    pub(super) fn take_up_slack(&self, state: &mut State) {
        let now = self.slackness(state, &Vector4::zeros());
        let gravity = self.gravity.torques(&state.gravity, &state.report.joints);
        let (mut slack, starts) = match state.doing {
            Doing::TakingUpSlack(slack) => (slack, false),
            _ => (self.slack.start(&now), true),
        };
        let limit = self.heating.limit(&state.heat);
        let weighs = self.gravity.weighs(&gravity, &state.gravity, &state.report.joints);
        let pulls = self.slack.step(&mut slack, &now, weighs);
        self.command_pulls(state, &pulls, &limit, starts);
        let DistributedTensions { tensions, scale } = self.reachable(&limit).distribute(&gravity);
        open_loop(state, pulls);
        if self.slack.tightens(&slack) {
            // The tendon controller continues from these pulls when the finger begins to follow a set point.
            state.tendons.integral = pulls - tensions;
            state.report.desired_tensions = tensions;
        }
        state.report.joint_torques = gravity;
        state.report.torque_scale = scale;
        state.report.slackest = self.slack.slackest(&slack, &now);
        state.report.under_tension &= self.slack.is_complete(&slack);
        state.doing = Doing::TakingUpSlack(slack);
    }

    /// Runs one cycle of tightening during a calibration. When the last tendon has become taut, the joints are held in
    /// the pose that they then have. `offset` is the error of the gauges (shown minus true tension), N.
    pub(super) fn tighten(&self, state: &mut State, offset: &Vector4<f64>) {
        let now = self.slackness(state, offset);
        let joints = Joints {
            // The estimates of state feedback are not used here. The controller of Figure 9, 10 or 11 controls the
            // tensions, and needs joint angles that are corrected for the low-pass filtered stretch of the tendons.
            angles: self.joint_positions.joints(&state.motor_angles, &state.tensions),
            rates: self.joint_positions.joint_rates(&state.motor_speeds),
        };
        let (mut tightening, starts) = match state.doing {
            Doing::Tightening(tightening) => (tightening, false),
            _ => (self.tightening.start(&now), true),
        };
        let limit = self.heating.limit(&state.heat);
        state.report.slackest = self.tightening.slackest(&tightening, &now);
        match self.tightening.step(&mut tightening, &now, &joints) {
            Tightened::Pull(pulls) => {
                self.command_pulls(state, &pulls, &limit, starts);
                open_loop(state, pulls);
            }
            Tightened::Hold { torques, below, begins } => {
                let DistributedTensions { tensions, scale } = self.reachable(&limit).distribute(&torques);
                self.control_tensions(state, tensions - below + offset, &limit, begins);
                state.report.joint_torques = torques;
                state.report.torque_scale = scale;
                state.report.under_tension &= below == Vector4::zeros();
            }
        }
        state.doing = Doing::Tightening(tightening);
    }

    /// Returns the measurements. The gauges show tensions that are too large by `offset`, N, so the offset is
    /// subtracted.
    fn slackness(&self, state: &State, offset: &Vector4<f64>) -> Slackness {
        Slackness {
            travel: state.motor_angles.component_mul(&self.radius),
            speeds: state.motor_speeds.component_mul(&self.radius),
            tensions: state.report.tensions - offset,
        }
    }
}
