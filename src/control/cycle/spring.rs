//! The fingertip as a spring, with the tendon controllers of Figures 9, 10 and 11, or with state feedback.

use super::{Controller, Doing, State};
use crate::control::signals::{Report, SetPoint};
use crate::control::spring::admissible_stiffness::UsedShares;
use crate::control::spring::joint_spring::JointSpring;
use crate::control::spring::soft_limits::Push;
use crate::control::spring::spring_transition::Spring;
use crate::control::state_feedback::decision::Decision;
use crate::control::tendons::tension_distribution::DistributedTensions;
use crate::model::JointSines;
use nalgebra::{Matrix3, Vector3};

/// With Figures 9, 10 and 11 a damper acts at the soft limits. This is its damping divided by the stiffness of the
/// limits, s.
const LIMIT_DAMPING: f64 = 0.015;

impl Controller {
    /// Follows the set point with the tendon controller of Figure 9, 10 or 11. The anchor starts at the present joint
    /// angles, so the spring starts without deflection.
    pub(super) fn follow(&self, state: &mut State, set_point: &SetPoint) {
        let (spring, joint_spring) = self.spring_transition.advance(&mut state.spring, set_point);
        let mut spring = self.joint_stiffness.posed(spring, &state.report.joints);
        let push = self.soft_limits.push(&state.report.joints);
        self.limit_stiffness(&mut state.report, &spring.k_theta, joint_spring, &push);
        let scale = state.report.stiffness_scale;
        spring.soften(scale);
        let (mut anchor, begins) = match state.doing {
            Doing::Following(anchor) => (anchor, false),
            _ => (state.report.joints, true),
        };
        let rates = set_point.motion.map_or_else(Vector3::zeros, |motion| motion.rates);
        // The slew limit acts on the distance between the anchor and the place where the set point was in the last
        // cycle. The motion of the set point is added afterwards, without this limit.
        let way = rates * self.period;
        self.slew.advance(&mut anchor, &(set_point.joints - way));
        anchor += way;
        state.doing = Doing::Following(anchor);
        let Report { joints, joint_rates, .. } = &state.report;
        let mut torques = spring.torques(&anchor);
        if let Some(joint_spring) = joint_spring.map(|joint_spring| joint_spring.softened(scale)) {
            torques += joint_spring.torques(&(anchor - joints));
            // The damper follows from the sum of the stiffnesses of both springs. The addition to `k_theta` does not
            // change the torque of the tip's spring, which is already computed.
            spring.k_theta += joint_spring.k_theta;
        }
        let torques = torques - spring.damper(&(joint_rates - rates));
        let damped = push.stiffness.component_mul(joint_rates) * LIMIT_DAMPING;
        let torques = torques + push.torque - damped + self.gravity.torques(&state.gravity, joints);
        let limit = self.heating.limit(&state.heat);
        let DistributedTensions { tensions: desired, scale } = self.reachable(&limit).distribute(&torques);
        self.control_tensions(state, desired, &limit, begins);
        state.report.joint_torques = torques;
        state.report.torque_scale = scale;
    }

    /// Follows the set point with state feedback. The anchor starts at the present joint angles, so the spring starts
    /// without deflection.
    pub(super) fn follow_by_state(&self, state: &mut State, set_point: &SetPoint) {
        let (spring, joint_spring) = self.spring_transition.advance(&mut state.spring, set_point);
        let mut pose = JointSines::of(&state.report.joints);
        let k_theta = self.joint_stiffness.joint_stiffness_at(spring, &pose);
        let push = self.soft_limits.push(&state.report.joints);
        let used = self.limit_stiffness(&mut state.report, &k_theta, joint_spring, &push);
        let scale = state.report.stiffness_scale;
        let softened;
        let spring = if scale == 1.0 {
            spring
        } else {
            softened = Spring { stiffness: spring.stiffness * scale, ..*spring };
            &softened
        };
        let joint_spring = &joint_spring.map(|joint_spring| joint_spring.softened(scale));
        let (Some(law), Some(law_state)) = (&self.state_feedback, &mut state.state_feedback) else {
            return;
        };
        // In the first cycle after another scheme, the joint angles in the report are not those of state feedback.
        if law_state.joints != state.report.joints {
            pose = JointSines::of(&law_state.joints);
        }
        let limit = self.heating.limit(&state.heat);
        let begins = !matches!(state.doing, Doing::Following(_));
        state.doing = Doing::Following(law_state.joints);
        let distribution = self.reachable(&(limit - law.upper_reserve));
        let springs = (spring, joint_spring, &set_point.motion);
        let gravity = (&self.gravity, &state.gravity);
        let Decision { pulls, against_friction, joint_torques, desired_tensions, torque_scale } =
            law.decide(law_state, &pose, springs, begins, (&self.soft_limits, used, gravity), &distribution);
        state.against_friction = against_friction;
        self.command_pulls(state, &pulls, &limit, false);
        state.report.joint_torques = joint_torques;
        state.report.desired_tensions = desired_tensions;
        state.report.torque_scale = torque_scale;
    }

    /// Writes to the report the factor, 0 to 1, by which the stiffness of both springs must be scaled. With this
    /// factor, the tendons are stiff enough in this pose for the springs and the soft limits together. `k_theta` is the
    /// stiffness of the tip's spring, N cm/rad. Returns the shares of the tendons' stiffness that the unscaled springs
    /// and the soft limits use.
    fn limit_stiffness(
        &self,
        report: &mut Report,
        k_theta: &Matrix3<f64>,
        joint: Option<&JointSpring>,
        push: &Push,
    ) -> UsedShares {
        let used = match joint {
            None => self.admissible.used(k_theta, &push.stiffness),
            Some(joint) => self.admissible.used(&(k_theta + joint.k_theta), &push.stiffness),
        };
        report.stiffness_scale = self.admissible.scale(used);
        used
    }
}
