//! The contact between a fingertip and an object (section 4.2 of the report) as one spatial stiffness, 6 x 6.

use crate::model::direction;
use nalgebra::allocator::Allocator;
use nalgebra::{Const, DefaultAllocator, DimDiff, DimSub, Matrix3, Matrix4, Matrix6, SMatrix, U1, Vector3};
use thiserror::Error;

/// Tolerance for an asymmetry or a negative eigenvalue of K, as a fraction of its largest entry or eigenvalue. It
/// covers the rounding of a planner that works in `float`.
const ROUNDING: f64 = 1e-3;

/// A negative eigenvalue of at most this fraction of the largest one is the rounding error of a zero, and is kept.
const NEGLIGIBLE: f64 = 64.0 * f64::EPSILON;

/// The spring of a contact as a symmetric, positive semi-definite 6 x 6 stiffness at the tip, in the axes of the
/// finger's frame. Rows and columns 0 to 2 are translation (N/cm), 3 to 5 are rotation (N cm/rad), and the blocks
/// between them are in N/rad.
///
/// A contact with D dimensions has a D x D stiffness K and a D x 6 selection S of the tip's motion. The 6 x 6 stiffness
/// is S^T K S. With the 6 x 3 Jacobian J of `Links::spatial_jacobian`, the D x 3 Jacobian of eq. 6 is S J, and
/// K_theta is (S J)^T K (S J).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact(Matrix6<f64>);

/// The reason why a stiffness is not that of a spring (finite, symmetric, without a negative eigenvalue), or why a
/// contact has no direction.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ContactError {
    /// K, the normal, the selection S or the product S^T K S contains NaN or infinity.
    #[error(
        "the stiffness of the contact, its normal, or the 6 x 6 stiffness that follows from them has the entry {0}: \
         send finite numbers that are so small that the 6 x 6 stiffness is finite too"
    )]
    NotFinite(f64),
    /// `K[row][column]` and `K[column][row]` differ.
    #[error(
        "the stiffness is not symmetric: its entries [{row}][{column}] and [{column}][{row}] differ by \
         {difference:.3e}, more than a thousandth of its largest entry. The stiffness of a spring is always symmetric: \
         send a symmetric one"
    )]
    NotSymmetric {
        /// Row of the first entry that differs too much from the entry with row and column exchanged.
        row: usize,
        /// Column of this entry.
        column: usize,
        /// Difference of the two entries, in their unit.
        difference: f64,
    },
    /// K has a negative eigenvalue.
    #[error(
        "the stiffness has the negative eigenvalue {smallest:.3e}: send a stiffness whose eigenvalues are zero or \
         positive"
    )]
    Negative {
        /// Smallest eigenvalue.
        smallest: f64,
    },
    /// The contact's normal is zero.
    #[error("the normal is zero, so it has no direction: pass a vector of any other length, such as 1")]
    NoNormal,
}

impl Contact {
    /// Constructs a hard finger with friction, which transmits three forces. `stiffness` is Kx, N/cm.
    ///
    /// # Errors
    /// Returns an error if Kx is not a spring.
    pub fn hard_finger(stiffness: Matrix3<f64>) -> Result<Self, ContactError> {
        Self::general(&stiffness, &translation())
    }

    /// Constructs a soft finger, which transmits three forces and a moment about `normal`, a vector of any length. Row
    /// and column 3 of `stiffness` belong to the rotation about `normal`: N cm/rad on the diagonal, otherwise N/rad.
    /// Three joints cannot turn the tip without moving it, so the rotational stiffness also makes the tip stiffer
    /// against motion in one direction.
    ///
    /// # Errors
    /// Returns an error if K or its translational block is not a spring, or if the normal is zero or not finite.
    pub fn soft_finger(stiffness: Matrix4<f64>, normal: Vector3<f64>) -> Result<Self, ContactError> {
        let (checked, normal) = directed(&stiffness, normal)?;
        // The rotational stiffness has another unit, and is often by far the largest entry. It must not determine how
        // negative a translational stiffness may be.
        spring(&stiffness.fixed_view::<3, 3>(0, 0).into_owned())?;
        let stiffness = checked;
        let mut selection = SMatrix::<f64, 4, 6>::zeros();
        selection.fixed_view_mut::<3, 6>(0, 0).copy_from(&translation());
        selection.fixed_view_mut::<1, 3>(3, 3).copy_from(&normal.transpose());
        Self::selected(&stiffness, &selection)
    }

    /// Constructs a frictionless point, which transmits a force along `normal`, a vector of any length. `stiffness` is
    /// in N/cm.
    ///
    /// # Errors
    /// Returns an error if the stiffness is negative or not finite, or if the normal is zero or not finite.
    pub fn frictionless_point(stiffness: f64, normal: Vector3<f64>) -> Result<Self, ContactError> {
        let (stiffness, normal) = directed(&SMatrix::<f64, 1, 1>::new(stiffness), normal)?;
        let mut selection = SMatrix::<f64, 1, 6>::zeros();
        selection.fixed_view_mut::<1, 3>(0, 0).copy_from(&normal.transpose());
        Self::selected(&stiffness, &selection)
    }

    /// Constructs any contact from its stiffness K with D dimensions and its selection S. Row i of S converts the tip's
    /// translation (cm) and rotation (rad) to deflection i.
    ///
    /// # Errors
    /// Returns an error if K is not a spring, or if an entry of S or of S^T K S is not finite.
    pub fn general<const D: usize>(
        stiffness: &SMatrix<f64, D, D>,
        selection: &SMatrix<f64, D, 6>,
    ) -> Result<Self, ContactError>
    where
        Const<D>: DimSub<U1>,
        DefaultAllocator: Allocator<Const<D>, DimDiff<Const<D>, U1>> + Allocator<DimDiff<Const<D>, U1>>,
    {
        finite(selection.as_slice())?;
        Self::selected(&nonnegative(stiffness)?, selection)
    }

    /// Returns S^T K S for a K that is a spring.
    fn selected<const D: usize>(
        stiffness: &SMatrix<f64, D, D>,
        selection: &SMatrix<f64, D, 6>,
    ) -> Result<Self, ContactError> {
        let spatial = selection.transpose() * stiffness * selection;
        // The product of finite factors may be infinite.
        finite(spatial.as_slice())?;
        // Rounding makes the product slightly asymmetric, but the servo relies on its symmetry.
        Ok(Self(symmetrised(&spatial)))
    }

    /// Returns the 6 x 6 stiffness.
    #[must_use]
    pub fn stiffness(&self) -> &Matrix6<f64> {
        &self.0
    }

    /// Returns the largest eigenvalue of the stiffness, N/cm, at most the largest finite number. A rotation is measured
    /// by the motion of a point at the distance `lever` (cm, 1e-3 or more) from the tip. With the length of the last
    /// link as `lever` the result is comparable with an eigenvalue of Kx, because joint 2 moves the tip and rotates it.
    #[must_use]
    pub fn largest_eigenvalue(&self, lever: f64) -> f64 {
        let (size, measured) = self.measured(lever);
        (measured.symmetric_eigenvalues().max() * size).min(f64::MAX)
    }

    /// Returns the nearest contact whose eigenvalues, as in [`Contact::largest_eigenvalue`], are between zero and
    /// `bound`. It has the same principal directions.
    #[must_use]
    pub fn clamped(&self, bound: f64, lever: f64) -> Self {
        let (size, measured) = self.measured(lever);
        let mut eigen = measured.symmetric_eigen();
        eigen.eigenvalues.apply(|eigenvalue| *eigenvalue = (*eigenvalue * size).clamp(0.0, bound));
        Self(symmetrised(&scaled(&eigen.recompose(), lever)))
    }

    /// Returns the largest entry, N/cm, and the stiffness divided by it, with rotations measured by `lever`. The
    /// division comes first. Otherwise a short lever could make entries infinite, and the eigenvalues NaN.
    fn measured(&self, lever: f64) -> (f64, Matrix6<f64>) {
        let size = self.0.amax().max(f64::MIN_POSITIVE);
        (size, symmetrised(&scaled(&(self.0 / size), 1.0 / lever)))
    }
}

/// Scales the rows and columns of the rotation by `factor`.
fn scaled(stiffness: &Matrix6<f64>, factor: f64) -> Matrix6<f64> {
    let scale = |index: usize| if index < 3 { 1.0 } else { factor };
    Matrix6::from_fn(|row, column| stiffness[(row, column)] * scale(row) * scale(column))
}

/// Returns the stiffness `asked`, made exactly symmetric, and its smallest and largest eigenvalue. The stiffness need
/// not have full rank.
///
/// # Errors
/// Returns an error if an entry is NaN or infinite, if the asymmetry exceeds a thousandth of the largest entry, or if
/// an eigenvalue is below minus a thousandth of the largest.
pub fn spring<const D: usize>(asked: &SMatrix<f64, D, D>) -> Result<(SMatrix<f64, D, D>, (f64, f64)), ContactError>
where
    Const<D>: DimSub<U1>,
    DefaultAllocator: Allocator<Const<D>, DimDiff<Const<D>, U1>> + Allocator<DimDiff<Const<D>, U1>>,
{
    finite(asked.as_slice())?;
    let tolerance = ROUNDING * asked.amax();
    for row in 0..D {
        for column in row + 1..D {
            let difference = (asked[(row, column)] - asked[(column, row)]).abs();
            if difference > tolerance {
                return Err(ContactError::NotSymmetric { row, column, difference });
            }
        }
    }
    let symmetric = symmetrised(asked);
    let eigenvalues = symmetric.symmetric_eigenvalues();
    let (smallest, largest) = (eigenvalues.min(), eigenvalues.max());
    // An eigenvalue may be infinite although every entry is finite.
    if smallest < -ROUNDING * largest.abs().max(smallest.abs()).min(f64::MAX) {
        return Err(ContactError::Negative { smallest });
    }
    Ok((symmetric, (smallest, largest)))
}

/// Returns the stiffness that [`spring`] returns, with its negative eigenvalues replaced by zero. The rows of S have
/// any length, so S^T K S could turn an eigenvalue slightly below zero into a large negative stiffness.
fn nonnegative<const D: usize>(asked: &SMatrix<f64, D, D>) -> Result<SMatrix<f64, D, D>, ContactError>
where
    Const<D>: DimSub<U1>,
    DefaultAllocator: Allocator<Const<D>, DimDiff<Const<D>, U1>> + Allocator<DimDiff<Const<D>, U1>>,
{
    let (checked, (smallest, largest)) = spring(asked)?;
    if smallest >= -NEGLIGIBLE * largest {
        return Ok(checked);
    }
    let mut eigen = checked.symmetric_eigen();
    eigen.eigenvalues.apply(|eigenvalue| *eigenvalue = eigenvalue.max(0.0));
    Ok(symmetrised(&eigen.recompose()))
}

/// Removes a slight asymmetry of a matrix, so that its eigenvalues can be computed for any finite entries. The halves
/// are added, because the sum of two entries may be infinite. Entries below the rounding error of the largest entry
/// become zero, because the squares of much smaller entries underflow in the iteration for the eigenvalues. Infinite
/// sums and underflow would give NaN eigenvalues, which pass every comparison with a bound.
fn symmetrised<const D: usize>(matrix: &SMatrix<f64, D, D>) -> SMatrix<f64, D, D> {
    let negligible = f64::EPSILON * matrix.amax();
    (matrix * 0.5 + matrix.transpose() * 0.5).map(|entry| if entry.abs() < negligible { 0.0 } else { entry })
}

fn finite(values: &[f64]) -> Result<(), ContactError> {
    values.iter().find(|value| !value.is_finite()).map_or(Ok(()), |&value| Err(ContactError::NotFinite(value)))
}

/// Returns the spring and the unit normal of a contact with a direction. If several inputs are invalid, the error is
/// the first of these: a normal that is not finite, a K that is not a spring, a normal that is zero.
fn directed<const D: usize>(
    stiffness: &SMatrix<f64, D, D>,
    normal: Vector3<f64>,
) -> Result<(SMatrix<f64, D, D>, Vector3<f64>), ContactError>
where
    Const<D>: DimSub<U1>,
    DefaultAllocator: Allocator<Const<D>, DimDiff<Const<D>, U1>> + Allocator<DimDiff<Const<D>, U1>>,
{
    finite(normal.as_slice())?;
    let checked = nonnegative(stiffness)?;
    Ok((checked, direction(&normal).ok_or(ContactError::NoNormal)?))
}

fn translation() -> SMatrix<f64, 3, 6> {
    SMatrix::<f64, 3, 6>::identity()
}

#[cfg(test)]
mod tests;
