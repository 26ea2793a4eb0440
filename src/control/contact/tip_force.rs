//! The force at the fingertip that exerts given torques on the joints: f = J^-T tau.
//!
//! Joint 0 turns the plane of the finger about the y axis. A force normal to this plane acts on joint 0 only, with the
//! distance of the tip from the axis as its arm. A force in the plane acts on joints 1 and 2 only.

use crate::model::Links;
use nalgebra::{Vector2, Vector3};
use serde::{Deserialize, Serialize};

/// The arm below which a direction is considered as not felt, cm. It is the limit of observability that `FingerTip`
/// uses.
const FELT: f64 = 0.3;

/// J^-T at one pose.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
pub(super) struct TipForce {
    /// Sine and cosine of theta_0.
    turn: Vector2<f64>,
    /// Force normal to the finger's plane per torque of joint 0, 1/cm.
    normal: f64,
    /// Force in the plane, away from the axis of joint 0, per torque of joints 1 and 2, 1/cm.
    outward: Vector2<f64>,
    /// Force along the y axis per torque of joints 1 and 2, 1/cm.
    along: Vector2<f64>,
}

impl TipForce {
    /// Returns J^-T at joint angles `theta`, rad. Near a singular pose, the inverse of each of the two blocks of J^T is
    /// a damped one.
    pub fn at(links: &Links, theta: &Vector3<f64>) -> Self {
        let [l0, l1, l2] = links.0;
        let (s0, c0) = theta[0].sin_cos();
        let (s1, c1) = theta[1].sin_cos();
        let (s12, c12) = (theta[1] + theta[2]).sin_cos();
        let reach = l0 + l1 * c1 + l2 * c12;
        // Columns of the Jacobian of the plane: joints 1 and 2. Rows: outward, along y.
        let (out1, out2) = (-l1 * s1 - l2 * s12, -l2 * s12);
        let (y1, y2) = (-l1 * c1 - l2 * c12, -l2 * c12);
        let determinant = out1 * y2 - out2 * y1;
        // The product of the two arms is the determinant, and the larger arm is about the norm.
        let least = FELT * FELT * (out1 * out1 + out2 * out2 + y1 * y1 + y2 * y2);
        let inverse = determinant / (determinant * determinant + 0.25 * least);
        Self {
            turn: Vector2::new(s0, c0),
            normal: reach / (reach * reach + 0.25 * FELT * FELT),
            outward: Vector2::new(y2, -y1) * inverse,
            along: Vector2::new(-out2, out1) * inverse,
        }
    }

    /// Returns the force, N in the finger's frame, of these joint torques, N cm.
    pub fn of(&self, torques: &Vector3<f64>) -> Vector3<f64> {
        let normal = self.normal * torques.x;
        let outward = self.outward.x * torques.y + self.outward.y * torques.z;
        let along = self.along.x * torques.y + self.along.y * torques.z;
        let (sin, cos) = (self.turn.x, self.turn.y);
        Vector3::new(normal * cos + outward * sin, along, outward * cos - normal * sin)
    }
}
