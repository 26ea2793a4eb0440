//! The mechanical stops of the joints: stiff, damped and one-sided.

use crate::model::configuration::ConfiguredFinger;
use crate::model::physics::{STOP_DAMPING, STOP_STIFFNESS};
use nalgebra::Vector3;

/// The angles of the stops of each joint, rad.
#[derive(Clone, Debug)]
pub(super) struct JointStops {
    lower: Vector3<f64>,
    upper: Vector3<f64>,
}

impl JointStops {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        let (lower, upper) = finger.joint_limits();
        let margin = finger.simulation.stop_margin_degrees.to_radians();
        Self { lower: lower.add_scalar(-margin), upper: upper.add_scalar(margin) }
    }

    /// Returns the torques on the joints, N m. A stop pushes a joint, and never pulls back a joint that leaves it.
    pub fn torque(&self, theta: &Vector3<f64>, rate: &Vector3<f64>) -> Vector3<f64> {
        Vector3::from_fn(|joint, _| {
            let depth = self.depth(theta, joint);
            let torque = -STOP_STIFFNESS * depth - STOP_DAMPING * rate[joint];
            if depth > 0.0 {
                torque.min(0.0)
            } else if depth < 0.0 {
                torque.max(0.0)
            } else {
                0.0
            }
        })
    }

    /// Returns the elastic energy, J.
    pub fn energy(&self, theta: &Vector3<f64>) -> f64 {
        (0..3).map(|joint| 0.5 * STOP_STIFFNESS * self.depth(theta, joint).powi(2)).sum()
    }

    /// Returns how far the joint is beyond its upper (positive) or lower (negative) stop, rad.
    fn depth(&self, theta: &Vector3<f64>, joint: usize) -> f64 {
        (theta[joint] - self.upper[joint]).max(0.0) + (theta[joint] - self.lower[joint]).min(0.0)
    }
}
