//! First-order low-pass filter with one value for each tendon.

use nalgebra::Vector4;

/// The filter y += gain (x - y). It has the pole of a continuous filter with the same corner frequency.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LowPass {
    gain: f64,
}

impl LowPass {
    /// Constructs a filter from its corner frequency and the rate, both in Hz.
    pub fn new(corner: f64, rate: f64) -> Self {
        Self { gain: -(-std::f64::consts::TAU * corner / rate).exp_m1() }
    }

    /// Advances `filtered` toward `input` by one cycle.
    #[inline]
    pub fn advance(&self, filtered: &mut Vector4<f64>, input: &Vector4<f64>) {
        *filtered += (input - *filtered) * self.gain;
    }
}
