//! Mean values over a period of time.

use nalgebra::Vector4;

/// Mean and standard deviation of four values.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Average {
    count: f64,
    sum: Vector4<f64>,
    /// The first value. The sums contain differences from it, because the squares of large counts would lose digits.
    first: Vector4<f64>,
    squares: Vector4<f64>,
}

impl Average {
    pub fn add(&mut self, value: Vector4<f64>) {
        if self.count == 0.0 {
            self.first = value;
        }
        let value = value - self.first;
        self.count += 1.0;
        self.sum += value;
        self.squares += value.component_mul(&value);
    }

    pub fn mean(&self) -> Vector4<f64> {
        self.first + self.sum / self.count.max(1.0)
    }

    /// Standard deviation.
    pub fn spread(&self) -> Vector4<f64> {
        let count = self.count.max(1.0);
        let mean = self.sum / count;
        (self.squares / count - mean.component_mul(&mean)).map(|variance| variance.max(0.0).sqrt())
    }
}
