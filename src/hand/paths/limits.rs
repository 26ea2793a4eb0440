//! Checks a path against the limits of its finger.

use crate::hand::PathError;
use crate::hand::admission::{Admission, PATH_ROUNDING};
use crate::model::path::{Piece, Start};
use nalgebra::Vector3;

/// The largest excess of a path over the limits of its rates, accelerations and jerk.
pub struct Excess {
    /// The factor by which the path must be slower.
    pub factor: f64,
    piece: usize,
    joint: usize,
    quantity: usize,
    value: f64,
}

const QUANTITIES: [(&str, &str); 3] = [("speed", "rad/s"), ("acceleration", "rad/s^2"), ("jerk", "rad/s^3")];

impl Admission {
    /// Refuses a path that leaves the joint limits. A path may begin at a set point beyond a limit, and return from
    /// there.
    pub(super) fn check_joint_limits(
        &self,
        pieces: &[Piece],
        per_pose: usize,
        start: &Vector3<f64>,
    ) -> Result<(), PathError> {
        let (low, high) = (self.joint_limits.0.inf(start), self.joint_limits.1.sup(start));
        for (index, piece) in pieces.iter().enumerate() {
            let (least, most) = piece.bounds(0);
            for joint in 0..3 {
                let (low, high) = (low[joint], high[joint]);
                let value = if most[joint] > high + PATH_ROUNDING { most[joint] } else { least[joint] };
                if value < low - PATH_ROUNDING || value > high + PATH_ROUNDING {
                    let (finger, pose) = (self.finger, index / per_pose);
                    return Err(PathError::BeyondJointLimit { finger, pose, joint, value, low, high });
                }
            }
        }
        Ok(())
    }

    /// Returns the largest excess over the limits of the motion; none if there is no excess. A path may begin with a
    /// motion that is beyond the limits, because it must continue that motion.
    pub(super) fn excess(&self, pieces: &[Piece], start: &Start) -> Option<Excess> {
        let begins = [start.rates, start.accelerations, start.jerk];
        let mut worst: Option<Excess> = None;
        for (index, piece) in pieces.iter().enumerate() {
            for (quantity, begin) in begins.iter().enumerate() {
                let (least, most) = piece.bounds(quantity + 1);
                for joint in 0..3 {
                    let value = most[joint].max(-least[joint]);
                    let limit = self.motion_limits.0[quantity].max(begin[joint].abs() * (1.0 + 1e-9));
                    // If a path is made slower by a factor, its n-th derivative is divided by the n-th power of the
                    // factor.
                    let factor = (value / limit).powf(1.0 / (quantity + 1) as f64);
                    if factor > 1.0 && worst.as_ref().is_none_or(|worst| factor > worst.factor) {
                        worst = Some(Excess { factor, piece: index, joint, quantity, value });
                    }
                }
            }
        }
        worst
    }

    /// Returns the error for a path that is too fast.
    pub(super) fn too_fast(&self, excess: &Excess, per_pose: usize) -> PathError {
        let &Excess { factor, piece, joint, quantity: index, value } = excess;
        let ((quantity, unit), limit) = (QUANTITIES[index], self.motion_limits.0[index]);
        // The error text shows the factor with two decimals. The factor is rounded up, so that a path that begins
        // at rest is admitted if its times are multiplied by it.
        let factor = (factor * 100.0).ceil() / 100.0;
        PathError::TooFast { finger: self.finger, pose: piece / per_pose, joint, quantity, unit, value, limit, factor }
    }
}
