//! The low-pass filter of the gauge amplifiers.

use nalgebra::Vector4;
use std::f64::consts::TAU;

/// A first-order low-pass for the four gauges.
#[derive(Clone, Debug)]
pub(super) struct GaugeFilter {
    /// Cut-off frequency, rad/s.
    bandwidth: f64,
    /// Filtered tensions, N.
    pub shown: Vector4<f64>,
}

impl GaugeFilter {
    /// `hertz` is the cut-off frequency. `tensions` are the tensions at the start, N. Returns None if the cut-off
    /// frequency is 0, which means no filter.
    pub fn new(hertz: f64, tensions: Vector4<f64>) -> Option<Self> {
        (hertz > 0.0).then_some(Self { bandwidth: TAU * hertz, shown: tensions })
    }

    /// Advances the filter by `h` seconds with the true tensions, N.
    pub fn advance(&mut self, tensions: &Vector4<f64>, h: f64) {
        self.shown += (tensions - self.shown) * -(-self.bandwidth * h).exp_m1();
    }
}
