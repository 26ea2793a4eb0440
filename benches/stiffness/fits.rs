//! Computes stiffnesses and slopes from recorded points.

use nalgebra::{Matrix3, Vector3};
pub use sun2xp::stability::growth;

/// Returns the relative error of a spring in its worst direction. K is the stiffness fitted to forces (N) and
/// deflections (cm). The error e is the largest singular value of S K S - 1, where S = Kx^-1/2. For every u, the ratio
/// of u^T K u to u^T Kx u is between 1 - e and 1 + e.
pub fn spring_error(forces: &[Vector3<f64>], deflections: &[Vector3<f64>], kx: &Matrix3<f64>) -> f64 {
    let found = apparent_stiffness(forces, deflections);
    let mut eigen = kx.symmetric_eigen();
    eigen.eigenvalues.apply(|stiffness| *stiffness = stiffness.sqrt().recip());
    let root = eigen.recompose();
    let error = root * found * root - Matrix3::identity();
    if error.iter().all(|entry| entry.is_finite()) { error.singular_values().max() } else { f64::INFINITY }
}

/// Returns the least-squares fit of K in f = K d, N/cm.
pub fn apparent_stiffness(forces: &[Vector3<f64>], deflections: &[Vector3<f64>]) -> Matrix3<f64> {
    let sum = |a: &[Vector3<f64>], b: &[Vector3<f64>]| -> Matrix3<f64> {
        a.iter().zip(b).map(|(a, b)| a * b.transpose()).sum()
    };
    let squared = sum(deflections, deflections);
    sum(forces, deflections) * squared.try_inverse().unwrap_or_else(|| Matrix3::repeat(f64::NAN))
}

/// Returns the least-squares slope of y over x.
pub fn slope(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|point| point.0), mean(|point| point.1));
    let above: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    above / points.iter().map(|point| (point.0 - x).powi(2)).sum::<f64>()
}
