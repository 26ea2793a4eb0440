//! The force at the fingertip that exerts given torques on the joints: f = J^-T tau.
//!
//! Joint 0 turns the plane of the finger about the y axis. A force normal to this plane acts on joint 0 only, and its
//! arm is the distance of the tip from the axis. A force in the plane acts on joints 1 and 2 only.

use crate::model::Links;
use nalgebra::{Matrix2, Vector2, Vector3};
use serde::{Deserialize, Serialize};

/// Moment arm, cm. A force with a smaller arm causes torques that are too small to measure. `FingertipState` uses the
/// same limit.
const FELT: f64 = 0.3;

/// The Jacobian of the tip at one pose, and its inverse.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
pub(super) struct TipForce {
    /// Sine and cosine of theta_0.
    turn: Vector2<f64>,
    /// Distance of the tip from the axis of joint 0, cm.
    reach: f64,
    /// Inverse of `reach`, 1/cm.
    normal: f64,
    /// Jacobian in the plane of the finger, cm/rad. The rows are the motion of the tip away from the axis of joint 0,
    /// and its motion along y. The columns are joints 1 and 2.
    plane: Matrix2<f64>,
    /// Transposed inverse of `plane`, 1/cm.
    inverse: Matrix2<f64>,
}

impl TipForce {
    /// Returns the force map at joint angles `theta`, rad. Near a singular pose the inverses are damped.
    pub fn at(links: &Links, theta: &Vector3<f64>) -> Self {
        let [l0, l1, l2] = links.0;
        let (s0, c0) = theta[0].sin_cos();
        let (s1, c1) = theta[1].sin_cos();
        let (s12, c12) = (theta[1] + theta[2]).sin_cos();
        let reach = l0 + l1 * c1 + l2 * c12;
        let plane = Matrix2::new(-l1 * s1 - l2 * s12, -l2 * s12, -l1 * c1 - l2 * c12, -l2 * c12);
        let determinant = plane.m11 * plane.m22 - plane.m12 * plane.m21;
        // The singular values of `plane` are the largest and the smallest moment arm of a force in the plane. The
        // determinant is their product, and the norm is about the larger one.
        let unfelt = FELT * FELT * plane.norm_squared();
        let scale = determinant / (determinant * determinant + 0.25 * unfelt);
        Self {
            turn: Vector2::new(s0, c0),
            reach,
            normal: reach / (reach * reach + 0.25 * FELT * FELT),
            plane,
            inverse: Matrix2::new(plane.m22, -plane.m21, -plane.m12, plane.m11) * scale,
        }
    }

    /// Returns the force, N in the finger's frame, of these joint torques, N cm.
    pub fn of(&self, torques: &Vector3<f64>) -> Vector3<f64> {
        self.turned(self.normal * torques.x, &(self.inverse * torques.yz()))
    }

    /// Returns the speed of the tip, cm/s in the finger's frame, at these joint rates, rad/s.
    pub fn speed(&self, rates: &Vector3<f64>) -> Vector3<f64> {
        self.turned(self.reach * rates.x, &(self.plane * rates.yz()))
    }

    /// Returns the vector with these components normal to the finger's plane and in it.
    fn turned(&self, normal: f64, plane: &Vector2<f64>) -> Vector3<f64> {
        let (sin, cos) = (self.turn.x, self.turn.y);
        Vector3::new(normal * cos + plane.x * sin, plane.y, plane.x * cos - normal * sin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::configuration::ConfiguredFinger;

    /// Poses far from the singular poses. The inverses are damped near singular poses.
    const POSES: [[f64; 3]; 3] = [[0.0, 0.5, 1.0], [-0.7, 1.0, 1.3], [0.5, -0.3, 0.8]];

    #[test]
    fn the_force_makes_the_torques() {
        let links = ConfiguredFinger::default().links();
        for pose in POSES {
            let (pose, force) = (Vector3::from(pose), Vector3::new(0.5, -1.0, 2.0));
            let found = TipForce::at(&links, &pose).of(&links.jacobian(&pose).tr_mul(&force));
            assert!((found - force).norm() < 0.02 * force.norm(), "{pose}: {found}");
        }
    }

    #[test]
    fn the_speed_is_that_of_the_jacobian() {
        let links = ConfiguredFinger::default().links();
        for pose in POSES {
            let (pose, rates) = (Vector3::from(pose), Vector3::new(0.3, -0.2, 0.9));
            let expected = links.jacobian(&pose) * rates;
            assert!((TipForce::at(&links, &pose).speed(&rates) - expected).norm() < 1e-12, "{pose}");
        }
    }

    #[test]
    fn a_force_along_a_straight_finger_is_not_guessed() {
        let links = ConfiguredFinger::default().links();
        for bent in [0.0, 0.01, -0.01] {
            let pose = Vector3::new(0.0, 0.0, bent);
            let force = TipForce::at(&links, &pose).of(&Vector3::new(0.1, 0.1, -0.1));
            assert!(force.norm() < 0.5, "{force}");
        }
    }
}
