//! Linear least squares, updated with each sample, in fixed memory.

use nalgebra::{SMatrix, SVector};

/// Normal equations of y = a x.
#[derive(Clone, Copy, Debug)]
pub(super) struct LeastSquares<const N: usize> {
    matrix: SMatrix<f64, N, N>,
    vector: SVector<f64, N>,
    squares: f64,
    count: f64,
}

impl<const N: usize> LeastSquares<N> {
    pub fn new() -> Self {
        Self { matrix: SMatrix::zeros(), vector: SVector::zeros(), squares: 0.0, count: 0.0 }
    }

    pub fn add(&mut self, x: &SVector<f64, N>, y: f64) {
        self.matrix += x * x.transpose();
        self.vector += x * y;
        self.squares += y * y;
        self.count += 1.0;
    }

    /// Returns the vector a and the rms residual, or `None` if the samples do not determine the vector.
    pub fn solve(&self) -> Option<(SVector<f64, N>, f64)> {
        // The matrix is scaled to a unit diagonal, so that one bound is valid for all units.
        let scale = self.matrix.diagonal().map(|entry| if entry > 0.0 { entry.sqrt().recip() } else { 0.0 });
        let scaled =
            SMatrix::<f64, N, N>::from_fn(|row, column| self.matrix[(row, column)] * scale[row] * scale[column]);
        let cholesky = scaled.cholesky()?;
        // The smallest squared pivot of the scaled matrix: the part of a column that the columns before it do not
        // explain.
        let least = cholesky.l().diagonal().map(|pivot| pivot * pivot).min();
        let a = cholesky.solve(&self.vector.component_mul(&scale)).component_mul(&scale);
        let left = (self.squares - a.dot(&self.vector)).max(0.0);
        (least > 1e-7).then(|| (a, (left / self.count).sqrt()))
    }
}
