//! Soft joint limits: beyond them, and before the mechanical stops, a joint is pushed back.

use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector3;

/// N cm/rad: about what a bent finger of 3 N/cm has, and far from what the tendons carry.
const STIFFNESS: f64 = 150.0;

/// tau_i = k (limit - theta_i) beyond a limit. Within the limits nothing is added: the spring of the fingertip stays exact.
#[derive(Clone, Debug)]
pub(super) struct SoftLimits {
    /// rad.
    low: Vector3<f64>,
    high: Vector3<f64>,
}

/// What the limits add.
#[derive(Clone, Copy, Debug)]
pub(super) struct Push {
    /// N cm.
    pub torque: Vector3<f64>,
    /// N cm/rad, of each joint; it wants a damper.
    pub stiffness: Vector3<f64>,
}

impl SoftLimits {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        let (low, high) = finger.joint_limits();
        Self { low, high }
    }

    /// At joint angles, rad.
    pub fn push(&self, joints: &Vector3<f64>) -> Push {
        let within = joints.zip_zip_map(&self.low, &self.high, |joint, low, high| joint.max(low).min(high));
        let beyond = within - joints;
        Push { torque: beyond * STIFFNESS, stiffness: beyond.map(|way| if way == 0.0 { 0.0 } else { STIFFNESS }) }
    }
}
