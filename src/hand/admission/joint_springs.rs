//! The checks of joint stiffnesses and joint torques.

use super::Admission;
use super::ranges::within_bound;
use crate::control::TensionDistribution;
use crate::hand::SetPointError;
use crate::model::configuration::OutOfRange;
use crate::model::{ContactError, spring};
use nalgebra::{Matrix3, Vector3};

/// Torque that no tendon of any finger can make, N cm. The part of it that the tension bounds permit is the largest
/// torque that the tendons can make.
const UNREACHABLE: f64 = 1e9;

impl Admission {
    /// Checks that the joint stiffness K_theta, N cm/rad, is symmetric, positive semi-definite and within the bound,
    /// and returns it. If `out_of_range` is `Clamp`, a K_theta beyond the bound is not refused: the nearest one within
    /// the bound is returned. The argument is `rows[row][column]`. The bound of an eigenvalue is the bound of Kx times
    /// the square of the last link's length; [`JointSpring::equivalent`](crate::control::JointSpring::equivalent) gives
    /// the reason.
    pub fn k_theta(&self, rows: [[f64; 3]; 3]) -> Result<Matrix3<f64>, SetPointError> {
        let finger = self.finger;
        let asked = Matrix3::from_fn(|row, column| rows[row][column]);
        let (symmetric, (smallest, largest)) = spring(&asked).map_err(|error| match error {
            ContactError::NotFinite(value) => SetPointError::NotFinite { what: "the joint stiffness", finger, value },
            source => SetPointError::JointStiffness { finger, source },
        })?;
        let bound = self.stiffness_bound * self.links.0[2].powi(2);
        let admitted = within_bound(symmetric, (smallest, largest), bound, self.out_of_range);
        admitted.ok_or(SetPointError::TooStiffJoints { finger, largest, bound })
    }

    /// Checks that the tendons can make a joint torque, N cm, within the bounds of their tensions, and returns it. The
    /// moment arms do not depend on the pose, so the torque is possible in every pose. If `out_of_range` is `Clamp`, a
    /// larger torque is not refused: it is reduced, and keeps its direction.
    pub fn torque(&self, torque: [f64; 3]) -> Result<Vector3<f64>, SetPointError> {
        self.finite("Torque", &torque)?;
        let finger = self.finger;
        let asked = Vector3::from(torque);
        let part = self.distribution.as_ref().map_or(0.0, |distribution| distribution.distribute(&asked).scale);
        if part >= 1.0 - 8.0 * f64::from(f32::EPSILON) {
            return Ok(asked);
        }
        if self.out_of_range == OutOfRange::Clamp {
            return Ok(asked * part);
        }
        let alone = |joint: usize, sign: f64| {
            let mut only = Vector3::zeros();
            only[joint] = sign * UNREACHABLE;
            self.distribution.as_ref().map_or(0.0, |tensions: &TensionDistribution| tensions.distribute(&only).scale)
                * only[joint]
        };
        let (least, most) = ([0, 1, 2].map(|joint| alone(joint, -1.0)), [0, 1, 2].map(|joint| alone(joint, 1.0)));
        Err(SetPointError::TooMuchTorque { finger, part, least, most })
    }
}
