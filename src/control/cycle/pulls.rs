//! What the motors pull: for desired tensions, without tension feedback, and on the way to nothing.

use super::{Controller, Doing, State};
use crate::control::tendons::release::Release;
use crate::control::tendons::tension_distribution::BoundedDistribution;
use crate::control::tendons::tension_integral::{TendonInput, TendonState};
use nalgebra::{Vector3, Vector4};

/// Below this part of its desired tension a tendon counts as slack while slack is taken up: well under what a motor
/// with the friction and the error of its torque constant reaches without the integral.
const SLACK: f64 = 0.2;

impl Controller {
    /// Tensions as they are asked for.
    pub(super) fn tense(&self, state: &mut State, desired: Vector4<f64>) {
        let begins = !matches!(state.doing, Doing::Tensing);
        state.doing = Doing::Tensing;
        self.bring(state, desired, &self.heating.limit(&state.heat), begins);
        state.report.joint_torques = Vector3::zeros();
        state.report.torque_scale = 1.0;
    }

    /// Pulls without tension feedback.
    pub(super) fn pull_freely(&self, state: &mut State, pulls: Vector4<f64>) {
        let speed = state.motor_speeds.component_mul(&self.radius);
        self.pull_with(state, pulls - speed * self.motor_damping);
    }

    /// Motor torques without any feedback.
    pub(super) fn turn(&self, state: &mut State, torques: Vector4<f64>) {
        self.pull_with(state, self.motor_torque.pulls(&torques));
    }

    fn pull_with(&self, state: &mut State, pulls: Vector4<f64>) {
        let limit = &self.motor_torque.limit;
        state.pulls = pulls.zip_map(limit, |pull, limit| pull.clamp(-limit, limit));
        state.doing = Doing::PullingFreely;
        open_loop(state, state.pulls);
    }

    /// The box R^-1, with motors that pull no more than `limit`, N: clamped there, they would turn the joint torque.
    pub(super) fn reachable(&self, limit: &Vector4<f64>) -> BoundedDistribution<'_> {
        self.distribution.below(&self.motor_torque.tensions(limit))
    }

    /// Desired tensions to pulls of at most `limit`, N: the tendon controller.
    pub(super) fn bring(&self, state: &mut State, desired: Vector4<f64>, limit: &Vector4<f64>, begins: bool) {
        let measured = state.report.tensions;
        let following = matches!(state.doing, Doing::Following(_));
        let slack = std::array::from_fn(|tendon| !following && measured[tendon] < SLACK * desired[tendon]);
        let speed = state.motor_speeds.component_mul(&self.radius);
        let input = TendonInput { desired, measured, speed, slack, limit: *limit, acted: state.acting };
        let asked = self.tendons.pulls(&mut state.tendons, &input);
        self.give(state, &asked, limit, begins);
        state.report.desired_tensions = desired;
    }

    /// Pulls to the motors: without a jump where something begins, and within their `limit`, N.
    pub(super) fn give(&self, state: &mut State, asked: &Vector4<f64>, limit: &Vector4<f64>, begins: bool) {
        let goes_on_from = state.goes_on_from.take();
        if let Some(before) = goes_on_from.or(begins.then_some(state.pulls)) {
            state.transition.begin(&before, asked);
        }
        let pulls = asked + state.transition.advance(self.period);
        state.pulls = pulls.zip_map(limit, |pull, limit| pull.clamp(-limit, limit));
    }

    /// Motor torques in a ramp to zero.
    pub(super) fn let_go(&self, state: &mut State, ramp: f64) {
        let mut release = match state.doing {
            Doing::Releasing(release) => release,
            _ => Release::new(state.pulls),
        };
        state.pulls = release.advance(self.period, ramp);
        state.doing = Doing::Releasing(release);
        open_loop(state, state.pulls);
    }
}

/// What such pulls leave behind: no tension controller decided them, and the next one begins anew.
pub(super) fn open_loop(state: &mut State, pulls: Vector4<f64>) {
    state.goes_on_from = None;
    state.tendons = TendonState::default();
    state.report.joint_torques = Vector3::zeros();
    state.report.desired_tensions = pulls;
    state.report.torque_scale = 1.0;
}
