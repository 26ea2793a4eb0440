//! The tendons of a finger: the matrix R with its ghost row, the inverse Q (eqs. 13-18), and the motor radii, which
//! determine M.

use nalgebra::{Matrix3x4, Matrix4, RowVector4, Vector4};
use thiserror::Error;

/// The reason why a matrix R cannot be used.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum TendonsError {
    /// R with its ghost row has no inverse.
    #[error(
        "the tendon matrix R with its ghost row is singular (its smallest singular value is {0:.1e}) and has no \
         inverse Q (eq. 17). Check its signs (the report misprints row 2, column 4, where -1.09 is right), and \
         remove geometry.ghost_row if it is set"
    )]
    Singular(f64),
    /// An entry of the fourth column of Q is not positive, so tendons, which can only pull, cannot hold the finger.
    #[error(
        "every entry of the ghost column of Q must be positive (eq. 20), but the column is {0:.3?}: with these \
         matrices the tendons cannot all pull while the joints are at rest. Check the signs of R (the report misprints \
         row 2, column 4, where -1.09 is right), and remove geometry.ghost_row if it is set"
    )]
    GhostColumn([f64; 4]),
}

/// The constant properties of the four tendons: R, its inverse with the ghost row, and the motor radii. The ghost row
/// is a fourth row for a joint that does not exist (the ghost joint). It makes R square and invertible (eq. 15).
#[derive(Clone, Debug, PartialEq)]
pub struct Tendons {
    /// R of eq. 14, cm: tau = R t. Rows are joints, and columns are tendons.
    pub r: Matrix3x4<f64>,
    /// Q = R^-1 of eq. 17, for R with its ghost row. Rows are tendons. The first three columns belong to joint torques
    /// (1/cm), and the last to the ghost joint.
    pub q: Matrix4<f64>,
    /// Equivalent shaft radius of each motor, cm: t = m_tau / radius, so M = diag(1 / radius) (eq. 21).
    pub radius: Vector4<f64>,
}

impl Tendons {
    /// Adds the ghost row to R and inverts it. Without `ghost` the null vector of R is used. A change of the pretension
    /// stretches the tendons. With the null vector, and if all tendons have the same stiffness, this stretch changes no
    /// joint angle that eq. 29 gives. Eq. 20 gives the same tensions with any ghost row.
    pub fn new(r: Matrix3x4<f64>, radius: Vector4<f64>, ghost: Option<RowVector4<f64>>) -> Result<Self, TendonsError> {
        let ghost = ghost.or_else(|| null_vector(&r)).ok_or(TendonsError::Singular(0.0))?;
        let mut with_ghost = Matrix4::zeros();
        with_ghost.fixed_rows_mut::<3>(0).copy_from(&r);
        with_ghost.set_row(3, &ghost);
        let singular = with_ghost.singular_values();
        let inverse = with_ghost.try_inverse().filter(|_| singular.min() > 1e-6 * singular.max());
        let q = inverse.ok_or(TendonsError::Singular(singular.min()))?;
        let column: [f64; 4] = q.column(3).into_owned().into();
        if column.iter().any(|&entry| entry.is_nan() || entry <= 1e-9) {
            return Err(TendonsError::GhostColumn(column));
        }
        Ok(Self { r, q, radius })
    }

    /// Returns the three rows of R^-T that convert tendon travel (cm) to joint angles (rad), eq. 27. Rows are joints.
    pub fn joints_from_travel(&self) -> Matrix3x4<f64> {
        self.q.fixed_columns::<3>(0).transpose()
    }

    /// Returns the tensions that cause no joint torque (eq. 20 at tau = 0), N. The smallest of them is `minimum`.
    pub fn pretension(&self, minimum: f64) -> Vector4<f64> {
        let column: Vector4<f64> = self.q.column(3).into_owned();
        column * (minimum / column.min())
    }
}

/// Returns the unit vector in tendon space that R maps to zero, with a positive sum. Returns None if the rank of R is
/// below 3.
fn null_vector(r: &Matrix3x4<f64>) -> Option<RowVector4<f64>> {
    let minor = |skip: usize| r.remove_column(skip).determinant();
    let cofactors = RowVector4::new(minor(0), -minor(1), minor(2), -minor(3));
    // No minor exceeds the product of the rows' lengths, so `rounding` is above the rounding errors of the cofactors.
    let rounding = 16.0 * f64::EPSILON * r.row_iter().map(|row| row.norm()).product::<f64>();
    let vector = cofactors.try_normalize(rounding)?;
    Some(if vector.sum() < 0.0 { -vector } else { vector })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::configuration::ConfiguredFinger;

    #[test]
    fn the_null_vector_does_not_depend_on_the_unit_of_length() {
        let r = ConfiguredFinger::default().r();
        let whole = null_vector(&r).expect("R has rank 3");
        assert!((r * whole.transpose()).amax() < 1e-15 && (whole.norm() - 1.0).abs() < 1e-15);
        // Powers of two scale without rounding.
        for scale in [2f64.powi(-40), 2f64.powi(-14), 2f64.powi(40)] {
            assert_eq!(null_vector(&(r * scale)), Some(whole), "{scale:e}");
        }
    }

    #[test]
    fn a_matrix_of_a_lower_rank_has_no_null_vector_at_any_scale() {
        let mut r = ConfiguredFinger::default().r();
        r.set_row(2, &(r.row(0) * 0.3 + r.row(1) * 1.7));
        for scale in [1e-9, 1.0, 1e9] {
            assert_eq!(null_vector(&(r * scale)), None, "{scale:e}");
        }
    }
}
