//! Computes the pull of every motor in a cycle of state feedback, from the estimated state and the spring.

use super::{StateFeedback, StateFeedbackState};
use crate::control::motion::Motion;
use crate::control::spring::admissible_stiffness::UsedShares;
use crate::control::spring::gravity_compensation::GravityCompensation;
use crate::control::spring::joint_spring::JointSpring;
use crate::control::spring::soft_limits::SoftLimits;
use crate::control::spring::spring_transition::Spring;
use crate::control::state_feedback::observer::TendonMotion;
use crate::control::state_feedback::reference::ReferenceMotion;
use crate::control::state_feedback::stiffening::{Added, StiffeningState};
use crate::control::tendons::tension_distribution::{BoundedDistribution, DistributedTensions};
use crate::model::JointSines;
use nalgebra::{Matrix3, Vector3, Vector4};

/// The result of a cycle.
pub(in crate::control) struct Decision {
    /// Pulls, N.
    pub pulls: Vector4<f64>,
    /// The friction feed-forward in the pulls, N.
    pub against_friction: Vector4<f64>,
    /// Joint torques, N cm.
    pub joint_torques: Vector3<f64>,
    /// Desired tensions with the dither, N.
    pub desired_tensions: Vector4<f64>,
    /// The fraction of the torque that the bounds permit.
    pub torque_scale: f64,
}

/// The motion of all tendons and joints in SI units, predicted for the moment `sample_offset` after the next sample, or
/// before it if the offset is negative.
struct FingerMotion {
    tensions: Vector4<f64>,
    motor_speeds: Vector4<f64>,
    /// Speeds of the joint side of each tendon.
    speeds: Vector4<f64>,
    disturbances: Vector4<f64>,
    joints: Vector3<f64>,
    rates: Vector3<f64>,
}

/// The torques of the joints, and the stiffness of their spring.
struct JointTorques {
    /// Torques of the spring, N cm.
    sprung: Vector3<f64>,
    /// Stiffness of the spring, N cm/rad.
    k_theta: Matrix3<f64>,
    /// All torques, N m.
    all: Vector3<f64>,
}

/// The dither of the joints and the dither of the tensions, together as tensions, N, and their rates, N/s.
struct Shake {
    tensions: Vector4<f64>,
    rates: Vector4<f64>,
}

impl StateFeedback {
    /// Returns the pulls that act from the next sample on. They give the fingertip the spring `spring`, and the joints
    /// the spring `joint_spring`. The anchor of both springs has the motion `motion`. If `begins` is true, the springs
    /// start without deflection. `pose` has the sines of the joint angles in `state`. `gravity` is the compensation,
    /// with the gravity that planners have set, m/s^2. `used` has the shares of the tendons' stiffness that the
    /// springs and the soft joint limits use.
    pub fn decide(
        &self,
        state: &mut StateFeedbackState,
        pose: &JointSines,
        (spring, joint_spring, motion): (&Spring, &Option<JointSpring>, &Option<Motion>),
        begins: bool,
        (limits, used, gravity): (&SoftLimits, UsedShares, (&GravityCompensation, &Option<Vector3<f64>>)),
        distribution: &BoundedDistribution,
    ) -> Decision {
        if begins {
            self.begin_without_deflection(state);
        }
        let mut now = self.predicted_motion(state);
        if begins {
            state.periodic_disturbance = self.periodic_disturbance.start(&now.disturbances);
        }
        let reference = self.follow(state, &spring.joints, motion);
        let inertia = self.dynamics.inertia_at(&state.joints, pose);
        let limits = (limits, used, gravity);
        let JointTorques { sprung, k_theta, all } =
            self.joint_torques(state, &now, (spring, joint_spring), &reference, &inertia, limits);
        let joint_torques = all * 100.0;
        let DistributedTensions { tensions: distributed, scale: torque_scale } =
            distribution.distribute(&joint_torques);
        if begins {
            state.transition.begin(&now.tensions, &distributed);
        }
        let shake = self.shake(state, (&distributed, &now.tensions), (&reference.rates, &sprung, &k_theta));
        let phase = self.dither.phase(&state.dither);
        now.disturbances +=
            self.periodic_disturbance.advance(&mut state.periodic_disturbance, &now.disturbances, &phase);
        let desired_tensions = distributed + shake.tensions;
        let error = desired_tensions + state.transition.advance(self.period) - now.tensions;
        let against_friction = self.friction.pulls(&now.motor_speeds, &now.tensions);
        let pulls = self.forces(&now, &error, &reference, &inertia, &shake) + against_friction;
        Decision { pulls, against_friction, joint_torques, desired_tensions, torque_scale }
    }

    fn begin_without_deflection(&self, state: &mut StateFeedbackState) {
        state.anchor = state.joints;
        state.reference = self.reference.start(&state.joints);
        state.along = None;
        state.drift = Vector3::zeros();
        state.creep = Vector4::zeros();
        state.stiffening = StiffeningState::default();
        state.dither = self.dither.start();
        state.tension_dither = self.tension_dither.start();
    }

    fn predicted_motion(&self, state: &StateFeedbackState) -> FingerMotion {
        let motion: [TendonMotion; 4] = std::array::from_fn(|tendon| self.motion(state, tendon));
        let of = |part: fn(&TendonMotion) -> f64| Vector4::from_fn(|tendon, _| part(&motion[tendon]));
        let speeds = of(|motion| motion.speed);
        FingerMotion {
            tensions: of(|motion| motion.tension),
            motor_speeds: of(|motion| motion.motor_speed),
            speeds,
            disturbances: of(|motion| motion.disturbance),
            joints: self.pseudo_inverse.tr_mul(&of(|motion| motion.travel)),
            // The observers have just computed these rates from the same `speeds`.
            rates: state.joint_rates,
        }
    }

    /// Advances the reference toward the set point, rad, or along with the motion of the set point.
    fn follow(
        &self,
        state: &mut StateFeedbackState,
        set_point: &Vector3<f64>,
        motion: &Option<Motion>,
    ) -> ReferenceMotion {
        let StateFeedbackState { reference, anchor, along, .. } = state;
        let reference = if let Some(motion) = motion {
            self.reference.advance_along(reference, anchor, along, &self.slew, (set_point, motion))
        } else {
            *along = None;
            self.slew.advance(anchor, set_point);
            self.reference.advance(reference, anchor)
        };
        state.jerk = reference.jerk;
        reference
    }

    /// Returns the joint torques: the sum of the torques of the spring, of its additional stiffness in a fast motion,
    /// of the soft limits, of the gravity compensation, of the damper, and of the feed-forward for friction and for the
    /// motion of the reference.
    fn joint_torques(
        &self,
        state: &mut StateFeedbackState,
        now: &FingerMotion,
        (spring, joint_spring): (&Spring, &Option<JointSpring>),
        reference: &ReferenceMotion,
        inertia: &Matrix3<f64>,
        (limits, used, (compensation, gravity)): (
            &SoftLimits,
            UsedShares,
            (&GravityCompensation, &Option<Vector3<f64>>),
        ),
    ) -> JointTorques {
        let push = limits.push(&now.joints);
        let pose = JointSines::of(&now.joints);
        let posed = self.joint_stiffness.posed_at(spring, &now.joints, &pose);
        let mut k_theta = posed.k_theta;
        let mut sprung = posed.torques(&reference.joints);
        let deflection = reference.joints - now.joints;
        if let Some(joint_spring) = joint_spring {
            k_theta += joint_spring.k_theta;
            sprung += joint_spring.torques(&deflection);
        }
        let added = self.stiffening.as_ref().map_or_else(Added::default, |stiffening| {
            stiffening.advance(&mut state.stiffening, (&reference.rates, &deflection), used)
        });
        let held_stiffness = (k_theta + added.stiffness + Matrix3::from_diagonal(&push.stiffness)) * 0.01;
        let apparent = self.apparent_motors + inertia;
        let damped = self.damped_motors + inertia;
        let damping = self.damping.damping(&damped, inertia, &held_stiffness, spring.damping);
        let joint_friction = self.joint_friction(state, &now.rates, &reference.rates, &damping);
        let held = sprung + added.torques + push.torque + compensation.torques(gravity, &now.joints);
        let rubbing = self.pulleys.as_ref().map_or_else(Vector3::zeros, |pulleys| {
            let speeds = (&self.r.tr_mul(&reference.rates), &self.r.tr_mul(&now.rates));
            self.r * pulleys.tensions(&mut state.creep, speeds, &now.tensions)
        });
        let all = held * 0.01 - damping * (now.rates - reference.rates)
            + rubbing
            + apparent * reference.accelerations
            + self.dynamics.coriolis_at(&now.joints, &pose, &reference.rates)
            + self.joint_viscous.component_mul(&reference.rates)
            + joint_friction;
        JointTorques { sprung, k_theta, all }
    }

    /// Returns the feed-forward of the joints' Coulomb friction, N m. Around zero speed it is proportional to the
    /// speed, with a fraction of the damping as the factor.
    fn joint_friction(
        &self,
        state: &mut StateFeedbackState,
        rates: &Vector3<f64>,
        reference_rates: &Vector3<f64>,
        damping: &Matrix3<f64>,
    ) -> Vector3<f64> {
        state.drift += (rates - reference_rates - state.drift) * self.drift_gain;
        let moving = reference_rates + state.drift;
        Vector3::from_fn(|joint, _| {
            let most = self.joint_coulomb[joint];
            (self.friction_slope * damping[(joint, joint)] * moving[joint]).clamp(-most, most)
        })
    }

    /// Returns the dither of the joints and of the tensions. `desired` are the tensions without it, `now` the present
    /// ones, N. `spring` has the joint rates of the reference, rad/s, the joint torque of the spring, N cm, and its
    /// stiffness, N cm/rad.
    fn shake(
        &self,
        state: &mut StateFeedbackState,
        (desired, now): (&Vector4<f64>, &Vector4<f64>),
        spring: (&Vector3<f64>, &Vector3<f64>, &Matrix3<f64>),
    ) -> Shake {
        let (shake, leading) = self.dither.advance(&mut state.dither);
        let phase = self.dither.phase(&state.dither);
        let amplitude = self.tension_dither.advance(&mut state.tension_dither, (desired, now), &phase, spring);
        Shake {
            tensions: self.pseudo_inverse * shake + amplitude * phase.x,
            rates: (self.pseudo_inverse * leading + amplitude * phase.y) * self.dither.frequency,
        }
    }

    /// Returns the pulls, N, that make the tendons force sources, without the friction feed-forward. The motor motion
    /// that the reference and the dither need is fed forward.
    fn forces(
        &self,
        now: &FingerMotion,
        error: &Vector4<f64>,
        reference: &ReferenceMotion,
        inertia: &Matrix3<f64>,
        shake: &Shake,
    ) -> Vector4<f64> {
        let tension_rates = self.pseudo_inverse * (inertia * reference.jerk);
        let tension_accelerations = self.pseudo_inverse * (inertia * reference.snap);
        let motor_rates = self.r.tr_mul(&reference.rates);
        let omega_squared = self.dither.frequency * self.dither.frequency;
        let error = self.scale_common(error, self.common_factors.gain);
        // `now.speeds` must have a coefficient of exactly 1. A coefficient of 0.94 acted as an additional damping of
        // three times the spring's damping.
        let stretching = now.motor_speeds - now.speeds - (tension_rates + shake.rates).component_div(&self.stiffness);
        let stretching = self.scale_common(&stretching, self.common_factors.damping);
        let yielding = (tension_accelerations - shake.tensions * omega_squared).component_div(&self.stiffness);
        now.tensions + error * self.inertia_gain - stretching * self.relative_damping - now.disturbances
            + self.viscous.component_mul(&motor_rates)
            + self.mass.component_mul(&yielding)
    }

    /// Scales the common component of `values` by `part`.
    fn scale_common(&self, values: &Vector4<f64>, part: f64) -> Vector4<f64> {
        values + self.common * (self.common.dot(values) * (part - 1.0))
    }
}
