//! Eigenvalues of a 3 x 3 matrix without iteration.

use nalgebra::Matrix3;
use std::f64::consts::TAU;

/// Returns the three real eigenvalues, the largest first. They are the roots of the characteristic polynomial, by the
/// trigonometric solution of the cubic equation. The matrix must be symmetric, or the product of two symmetric positive
/// semi-definite matrices. The function is inlined, so that a caller that uses only the largest eigenvalue computes
/// only one cosine.
#[inline]
pub(super) fn eigenvalues(matrix: &Matrix3<f64>) -> [f64; 3] {
    let square = matrix * matrix;
    let first = matrix.trace();
    let second = 0.5 * (first * first - square.trace());
    let third = first / 3.0;
    let spread = (third * third - second / 3.0).max(0.0);
    let root = spread.sqrt();
    if root <= 1e-12 * third.abs() {
        return [third; 3];
    }
    let cubic = third * third * third - 0.5 * third * second + 0.5 * matrix.determinant();
    let angle = (cubic / (spread * root)).clamp(-1.0, 1.0).acos() / 3.0;
    let part = |index: f64| third + 2.0 * root * (angle - TAU / 3.0 * index).cos();
    [part(0.0), part(1.0), part(2.0)]
}
