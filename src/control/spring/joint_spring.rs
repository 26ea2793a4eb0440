//! A spring in joint angles: a joint stiffness K_theta and a constant joint torque.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// A spring between the joint angles and their set point, with a constant torque in addition:
/// tau = K_theta (theta_d - theta) + torque. It acts in addition to the spring of the fingertip.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct JointSpring {
    /// K_theta, N cm/rad, symmetric and positive semi-definite. Rows and columns are joints 0 to 2.
    pub k_theta: Matrix3<f64>,
    /// Constant torque of joints 0 to 2, N cm.
    pub torque: Vector3<f64>,
}

impl JointSpring {
    /// Returns the spring, or none if it has neither stiffness nor torque.
    pub fn unless_zero(self) -> Option<Self> {
        (self != Self::default()).then_some(self)
    }

    /// Converts K_theta to a stiffness of the tip, N/cm, from which the permitted range of the damping ratio is
    /// computed. This is the largest eigenvalue of K_theta divided by the square of `lever`, the length of the last
    /// link, cm.
    ///
    /// Joint 2 moves the tip by this lever in every pose, so a Kx of this size gives joint 2 the same stiffness. A
    /// shorter lever makes the equivalent stiffer, and the range of the damping narrower. The lever of joint 2, which
    /// is the shortest one in most poses, is used for all joints, because K_theta does not become softer where the
    /// levers and the inertia of joints 0 and 1 are small, in a folded finger.
    pub fn equivalent(&self, lever: f64) -> f64 {
        self.k_theta.symmetric_eigenvalues().max() / (lever * lever)
    }

    /// Returns the spring with its stiffness scaled by `part`. The constant torque is not a stiffness, so it is not
    /// scaled.
    pub(crate) fn softened(&self, part: f64) -> Self {
        Self { k_theta: self.k_theta * part, torque: self.torque }
    }

    /// Returns tau, N cm. `deflection` is theta_d - theta, rad.
    pub(crate) fn torques(&self, deflection: &Vector3<f64>) -> Vector3<f64> {
        self.k_theta * deflection + self.torque
    }

    /// Moves the spring toward `target` by the fraction `part` of the difference.
    pub(crate) fn approach(&mut self, target: &Self, part: f64) {
        self.k_theta += (target.k_theta - self.k_theta) * part;
        self.torque += (target.torque - self.torque) * part;
    }

    /// Returns whether all entries of K_theta, N cm/rad, and of the torque, N cm, have magnitudes of at most `least`.
    pub(crate) fn is_below(&self, least: f64) -> bool {
        self.k_theta.amax() <= least && self.torque.amax() <= least
    }
}
