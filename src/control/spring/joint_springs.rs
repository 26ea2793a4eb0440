//! The stiffness of all springs that the controller puts on the joints of a finger.

use crate::control::signals::SetPoint;
use crate::control::spring::admissible_stiffness::AdmissibleStiffness;
use crate::control::spring::joint_stiffness::JointStiffness;
use crate::control::spring::soft_limits::SoftLimits;
use crate::model::configuration::ConfiguredFinger;
use nalgebra::{Matrix3, Vector3};

/// The springs of one finger: the spring of the set point, the spring that holds joint 0 while the tip is near the axis
/// of this joint, and the soft joint limits. The same stiffness is computed for every controller, and for both values
/// of `controller.law`. It is the true stiffness of the joints only at small deflections.
#[derive(Clone, Debug)]
pub struct JointSprings {
    joint_stiffness: JointStiffness,
    soft_limits: SoftLimits,
}

impl JointSprings {
    /// Constructs the springs of `finger` at `rate`, Hz. Returns None if the moment arms R of the tendons cannot be
    /// used. No controller accepts such an R.
    pub fn new(finger: &ConfiguredFinger, rate: f64) -> Option<Self> {
        let admissible = AdmissibleStiffness::new(finger, &finger.tendons().ok()?, rate)?;
        Some(Self {
            // `rate_time` affects only the damper.
            joint_stiffness: JointStiffness::new(finger.links(), 0.0),
            soft_limits: SoftLimits::new(finger, &admissible.of_joints()),
        })
    }

    /// Returns the stiffness of the joints, N cm/rad, at joint angles, rad. `scale` is the fraction of the stiffness of
    /// `set_point` that is in force, [`Report::stiffness_scale`](crate::control::Report::stiffness_scale).
    pub fn stiffness(&self, set_point: &SetPoint, scale: f64, joints: &Vector3<f64>) -> Matrix3<f64> {
        let mut held = self.joint_stiffness.joint_stiffness(&(*set_point).into(), joints);
        if let Some(joint_spring) = &set_point.joint_spring {
            held += joint_spring.k_theta;
        }
        held * scale + Matrix3::from_diagonal(&self.soft_limits.push(joints).stiffness)
    }
}
