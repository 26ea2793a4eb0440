//! Takes up slack: brings every tendon under tension and holds the joints where they are.

use super::pulls::open_loop;
use super::{Controller, Doing, State};
use crate::control::take_up::slack::{Slackness, TakeUp};
use crate::control::tendons::tension_distribution::DistributedTensions;
use nalgebra::{Vector3, Vector4};

impl Controller {
    /// Runs one cycle of taking up slack. The joints are held where they are when the last tendon comes taut. `offset`
    /// is the error of the gauges (shown minus true tension), N. `gravity` is the torque that holds the links, N cm.
    pub(super) fn take_up_slack(&self, state: &mut State, offset: &Vector4<f64>, gravity: Vector3<f64>) {
        let now = Slackness {
            travel: state.motor_angles.component_mul(&self.radius),
            speeds: state.motor_speeds.component_mul(&self.radius),
            tensions: state.report.tensions - offset,
            // The joints that state feedback observes are not used: Figures 9 and 10 control the tensions here, and
            // they need the low-pass filtered stretch.
            joints: self.joint_positions.joints(&state.motor_angles, &state.tensions),
            joint_rates: self.joint_positions.joint_rates(&state.motor_speeds),
        };
        let (mut slack, starts) = match state.doing {
            Doing::TakingUpSlack(slack) => (slack, false),
            _ => (self.slack.start(&now), true),
        };
        let limit = self.heating.limit(&state.heat);
        state.report.slackest = self.slack.slackest(&slack, &now);
        match self.slack.step(&mut slack, &now) {
            TakeUp::Pull(pulls) => {
                self.command_pulls(state, &pulls, &limit, starts);
                open_loop(state, pulls);
            }
            TakeUp::Hold { torques, below, begins } => {
                let torques = torques + gravity;
                let DistributedTensions { tensions, scale } = self.reachable(&limit).distribute(&torques);
                self.control_tensions(state, tensions - below + offset, &limit, begins);
                state.report.joint_torques = torques;
                state.report.torque_scale = scale;
                state.report.under_tension &= below == Vector4::zeros();
            }
        }
        state.doing = Doing::TakingUpSlack(slack);
    }
}
