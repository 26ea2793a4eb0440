//! First-order low-pass for one value a tendon.

use nalgebra::Vector4;

/// y += gain (x - y), with the pole of a continuous filter of the same corner frequency.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LowPass {
    gain: f64,
}

impl LowPass {
    /// Corner frequency and rate, Hz.
    pub fn new(corner: f64, rate: f64) -> Self {
        Self { gain: -(-std::f64::consts::TAU * corner / rate).exp_m1() }
    }

    /// Moves `filtered` toward `input` by one cycle.
    pub fn advance(&self, filtered: &mut Vector4<f64>, input: &Vector4<f64>) {
        *filtered += (input - *filtered) * self.gain;
    }
}
