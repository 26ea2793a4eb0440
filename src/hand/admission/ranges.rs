//! The ranges of joint angles and Kx. A client that uses a hand on another machine checks its commands with these
//! ranges too.

use crate::hand::SetPointError;
use crate::model::configuration::OutOfRange;
use crate::model::{ContactError, FingerNumber, spring};
use nalgebra::{Matrix3, Vector3};

/// The ranges of one finger.
#[derive(Clone, Copy, Debug)]
pub struct Ranges {
    /// The finger.
    pub finger: FingerNumber,
    /// Lower and upper joint limits, rad.
    pub joint_limits: (Vector3<f64>, Vector3<f64>),
    /// Bound on the largest eigenvalue of Kx, N/cm.
    pub stiffness_bound: f64,
    /// Whether a value outside its range is refused or clamped.
    pub out_of_range: OutOfRange,
}

impl Ranges {
    /// Checks desired joint angles, rad, and returns the angles for the servo. If `out_of_range` is `Clamp`, an angle
    /// outside its limits is not refused: the limit is returned.
    ///
    /// # Errors
    /// Returns an error if an angle is not finite, or if it is outside its limits and `out_of_range` is `Refuse`.
    #[inline]
    pub fn joints(&self, joints: [f64; 3]) -> Result<Vector3<f64>, SetPointError> {
        self.finite("Pos", &joints)?;
        let mut admitted = Vector3::from(joints);
        for joint in 0..3 {
            let (low, high) = (self.joint_limits.0[joint], self.joint_limits.1[joint]);
            // An angle at a limit may be rounded beyond the limit when it is sent as `float`. It must be accepted.
            let rounding = f64::from(f32::EPSILON) * low.abs().max(high.abs());
            let value = joints[joint];
            if (value < low - rounding || value > high + rounding) && self.out_of_range == OutOfRange::Refuse {
                return Err(SetPointError::BeyondJointLimit { finger: self.finger, joint, value, low, high });
            }
            admitted[joint] = value.clamp(low, high);
        }
        Ok(admitted)
    }

    /// Checks that Kx, N/cm, is symmetric, positive semi-definite and within the bound, and returns it. Mirrored
    /// entries are averaged. If `out_of_range` is `Clamp`, a Kx beyond the bound is not refused: the nearest one within
    /// the bound is returned. The argument is `rows[row][column]`.
    ///
    /// # Errors
    /// Returns an error if Kx is not finite or is not a spring, or if it is too stiff and `out_of_range` is `Refuse`.
    pub fn kx(&self, rows: [[f64; 3]; 3]) -> Result<Matrix3<f64>, SetPointError> {
        // nalgebra is column-major, and `rows` is row-major.
        let asked = Matrix3::from_fn(|row, column| rows[row][column]);
        let (symmetric, (smallest, largest)) = spring(&asked).map_err(|error| self.no_spring(error))?;
        let bound = self.stiffness_bound;
        within_bound(symmetric, (smallest, largest), bound, self.out_of_range).ok_or(SetPointError::TooStiff {
            finger: self.finger,
            largest,
            bound,
        })
    }

    /// The error for a Kx that is not a spring.
    fn no_spring(&self, error: ContactError) -> SetPointError {
        let finger = self.finger;
        match error {
            ContactError::NotFinite(value) => SetPointError::NotFinite { what: "Kx", finger, value },
            ContactError::NotSymmetric { row, column, difference } => {
                SetPointError::NotSymmetric { finger, row, column, difference }
            }
            ContactError::Negative { smallest } => SetPointError::Negative { finger, smallest },
            ContactError::NoNormal => SetPointError::Contact { finger, source: error },
        }
    }

    /// Refuses NaN and infinity, which must never reach the servo. `what` names the argument.
    ///
    /// # Errors
    /// Returns an error if a value is not finite.
    pub fn finite(&self, what: &'static str, values: &[f64]) -> Result<(), SetPointError> {
        match values.iter().find(|value| !value.is_finite()) {
            None => Ok(()),
            Some(&value) => Err(SetPointError::NotFinite { what, finger: self.finger, value }),
        }
    }
}

/// Returns the stiffness `symmetric`, whose smallest and largest eigenvalues are given, if none of its eigenvalues is
/// negative or exceeds `bound` by more than a rounding error. Otherwise returns the nearest stiffness whose eigenvalues
/// are from zero to `bound`, or none if `symmetric` is stiffer than `bound` and must be refused.
pub(super) fn within_bound(
    symmetric: Matrix3<f64>,
    (smallest, largest): (f64, f64),
    bound: f64,
    out_of_range: OutOfRange,
) -> Option<Matrix3<f64>> {
    // A stiffness at the bound may be rounded beyond the bound when it is sent as `float`. It must be accepted.
    let too_stiff = largest > bound * (1.0 + 8.0 * f64::from(f32::EPSILON));
    if too_stiff && out_of_range == OutOfRange::Refuse {
        return None;
    }
    if !too_stiff && smallest >= 0.0 {
        return Some(symmetric);
    }
    // The nearest admissible spring has the same principal directions.
    let mut eigen = symmetric.symmetric_eigen();
    eigen.eigenvalues.apply(|eigenvalue| *eigenvalue = eigenvalue.clamp(0.0, bound));
    let recomposed = eigen.recompose();
    Some((recomposed + recomposed.transpose()) * 0.5)
}
