//! The pulls of the motors: with control of the tensions, without feedback from the gauges, and during a release.

use super::{Controller, Doing, State};
use crate::control::tendons::release::Release;
use crate::control::tendons::tension_distribution::BoundedDistribution;
use crate::control::tendons::tension_integral::{TendonInput, TendonState};
use nalgebra::{Vector3, Vector4};

/// Fraction of its desired tension below which a tendon counts as slack while the finger does not follow a set point. A
/// motor brings a tight tendon to a much larger fraction even without the integral of the tendon controller, and
/// despite its friction and the error of its torque constant.
const SLACK: f64 = 0.2;

impl Controller {
    /// Controls the tensions to the desired ones, N.
    pub(super) fn tense(&self, state: &mut State, desired: Vector4<f64>) {
        let begins = !matches!(state.doing, Doing::Tensing);
        state.doing = Doing::Tensing;
        self.control_tensions(state, desired, &self.heating.limit(&state.heat), begins);
        state.report.joint_torques = Vector3::zeros();
        state.report.torque_scale = 1.0;
    }

    /// Commands pulls, N, with no feedback except the damper of the motors.
    pub(super) fn pull_freely(&self, state: &mut State, pulls: Vector4<f64>) {
        let speed = state.motor_speeds.component_mul(&self.radius);
        self.pull_open_loop(state, pulls - speed * self.motor_damping);
    }

    /// Applies motor torques, N cm, without any feedback.
    pub(super) fn turn(&self, state: &mut State, torques: Vector4<f64>) {
        self.pull_open_loop(state, self.motor_torque.pulls(&torques));
    }

    fn pull_open_loop(&self, state: &mut State, pulls: Vector4<f64>) {
        let limit = &self.motor_torque.limit;
        state.pulls = pulls.zip_map(limit, |pull, limit| pull.clamp(-limit, limit));
        state.doing = Doing::PullingFreely;
        open_loop(state, state.pulls);
    }

    /// Returns the distribution of joint torques to tensions (the block R^-1 of Figure 9), limited to tensions that the
    /// motors reach with pulls of at most `limit`, N. Clamping the pulls instead would change the direction of the
    /// joint torque.
    pub(super) fn reachable(&self, limit: &Vector4<f64>) -> BoundedDistribution<'_> {
        self.distribution.below(&self.motor_torque.tensions(limit))
    }

    /// Runs the tendon controller, which converts desired tensions to pulls of at most `limit`, N.
    #[inline]
    pub(super) fn control_tensions(
        &self,
        state: &mut State,
        desired: Vector4<f64>,
        limit: &Vector4<f64>,
        begins: bool,
    ) {
        let measured = state.report.tensions;
        let following = matches!(state.doing, Doing::Following(_));
        let slack = std::array::from_fn(|tendon| !following && measured[tendon] < SLACK * desired[tendon]);
        let speed = state.motor_speeds.component_mul(&self.radius);
        let input = TendonInput { desired, measured, speed, slack, limit: *limit, acted: state.acting };
        let asked = self.tendons.pulls(&mut state.tendons, &input);
        self.command_pulls(state, &asked, limit, begins);
        state.report.desired_tensions = desired;
    }

    /// Commands the pulls `asked`, limited to `limit`, N. If an activity begins, or this controller replaces another
    /// one, the pulls change without a jump.
    #[inline]
    pub(super) fn command_pulls(&self, state: &mut State, asked: &Vector4<f64>, limit: &Vector4<f64>, begins: bool) {
        let goes_on_from = state.goes_on_from.take();
        if let Some(before) = goes_on_from.or(begins.then_some(state.pulls)) {
            state.transition.begin(&before, asked);
        }
        let pulls = asked + state.transition.advance(self.period);
        state.pulls = pulls.zip_map(limit, |pull, limit| pull.clamp(-limit, limit));
    }

    /// Ramps the pulls to zero.
    pub(super) fn release(&self, state: &mut State, ramp: f64) {
        let mut release = match state.doing {
            Doing::Releasing(release) => release,
            _ => Release::new(state.pulls),
        };
        state.pulls = release.advance(self.period, ramp);
        state.doing = Doing::Releasing(release);
        open_loop(state, state.pulls);
    }
}

/// Reports pulls that the tendon controller did not compute, and resets the state of the tendon controller.
pub(super) fn open_loop(state: &mut State, pulls: Vector4<f64>) {
    state.goes_on_from = None;
    state.tendons = TendonState::default();
    state.report.joint_torques = Vector3::zeros();
    state.report.desired_tensions = pulls;
    state.report.torque_scale = 1.0;
}
