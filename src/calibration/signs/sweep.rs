//! Reads the gauges while one motor turns back and forth.

use crate::calibration::average::Average;
use nalgebra::Vector4;

/// Amplitude of the first sweep, cm. The amplitude is doubled until one side is tight and the other slack.
const SMALLEST_AMPLITUDE: f64 = 0.05;
/// Largest permitted amplitude, cm.
const LARGEST_AMPLITUDE: f64 = 1.0;
/// Positions at which the motor stops, in amplitudes.
const POSITIONS: [f64; 5] = [0.5, 1.0, -0.5, -1.0, 0.0];
/// Settling time at each position, s.
const SETTLING: f64 = 0.15;
/// Reading time at each position, after the settling time, s.
const READING: f64 = 0.1;
/// A motor has stalled if it lags by more than the first value, cm, plus the second value times the amplitude.
const STALLED: (f64, f64) = (0.03, 0.25);
/// A side is tight if a tension changes by more than this over the outer half of the side, N, or if the motor stalls at
/// the end of the side.
pub(super) const TIGHT: f64 = 0.5;
/// A side is slack if every tension changes by less than this over the outer half of the side, N, and the motor does
/// not stall at the end of the side.
const SLACK: f64 = 0.25;

/// A sweep: one motor turns back and forth, to both sides of `centre`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sweep {
    pub centre: f64,
    pub amplitude: f64,
    position: usize,
    /// Time at the position, s.
    seconds: f64,
    gauges: Average,
    read: [Vector4<f64>; 4],
    stalled: [bool; 4],
}

impl Sweep {
    /// Creates the smallest sweep about `centre`, cm.
    pub fn first(centre: f64) -> Self {
        Self::new(centre, SMALLEST_AMPLITUDE)
    }

    /// Returns a sweep of twice the amplitude, or `None` if that is too large.
    pub fn wider(&self) -> Option<Self> {
        let amplitude = self.amplitude * 2.0;
        (amplitude <= LARGEST_AMPLITUDE).then(|| Self::new(self.centre, amplitude))
    }

    fn new(centre: f64, amplitude: f64) -> Self {
        let read = [Vector4::zeros(); 4];
        Self { centre, amplitude, position: 0, seconds: 0.0, gauges: Average::default(), read, stalled: [false; 4] }
    }

    /// Returns the current target of the motor, cm.
    pub fn aim(&self) -> f64 {
        self.centre + POSITIONS[self.position] * self.amplitude
    }

    /// Adds a cycle at the current position: the raw counts of the gauges, newtons per count, and the lag of the motor,
    /// cm. Returns whether the motor has been at every position.
    pub fn dwell(&mut self, period: f64, counts: [u16; 4], newton_per_count: &Vector4<f64>, lag: f64) -> bool {
        self.seconds += period;
        if self.seconds > SETTLING {
            self.gauges.add(Vector4::from(counts.map(f64::from)));
        }
        if self.seconds < SETTLING + READING {
            return false;
        }
        if let Some(read) = self.read.get_mut(self.position) {
            *read = self.gauges.mean().component_mul(newton_per_count);
            self.stalled[self.position] = lag > STALLED.0 + STALLED.1 * self.amplitude;
        }
        (self.position, self.seconds, self.gauges) = (self.position + 1, 0.0, Average::default());
        self.position == POSITIONS.len()
    }

    /// Returns the difference of the tensions between the two ends of the sweep, N.
    pub fn change_between_ends(&self) -> Vector4<f64> {
        self.read[1] - self.read[3]
    }

    /// Returns the tight side if the other side is slack: +1 for rising counts, -1 for falling counts. Returns `None`
    /// if the difference between the sides is not clear.
    pub fn tight_side(&self) -> Option<f64> {
        let change = |inner: usize, outer: usize| (self.read[outer] - self.read[inner]).amax();
        let tight = |inner, outer: usize| change(inner, outer) > TIGHT || self.stalled[outer];
        let slack = |inner, outer: usize| change(inner, outer) < SLACK && !self.stalled[outer];
        if tight(0, 1) && slack(2, 3) {
            Some(1.0)
        } else if tight(2, 3) && slack(0, 1) {
            Some(-1.0)
        } else {
            None
        }
    }
}
