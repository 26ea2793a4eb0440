//! Checks that the joints do not move while the encoders are read.

use nalgebra::Vector3;

/// Largest permitted deviation of a joint, rad. It bounds the error of the zeros.
pub(super) const TOLERANCE: f64 = 0.004;

/// Usual time constant of the low-pass filter on the joints, s. The filter removes the noise of the gauges and the
/// oscillation caused by state feedback.
const SMOOTHING: f64 = 0.02;

/// Mean and extremes of the joint angles over a period of time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Standstill {
    /// Time constant of the low-pass filter, s.
    smoothing: f64,
    samples: f64,
    sum: Vector3<f64>,
    smoothed: Vector3<f64>,
    /// `None` until the filter has settled.
    extremes: Option<(Vector3<f64>, Vector3<f64>)>,
}

impl Default for Standstill {
    fn default() -> Self {
        Self::new(SMOOTHING)
    }
}

impl Standstill {
    /// `smoothing`: time constant of the low-pass filter, s.
    pub fn new(smoothing: f64) -> Self {
        let (samples, sum, smoothed) = (0.0, Vector3::zeros(), Vector3::zeros());
        Self { smoothing, samples, sum, smoothed, extremes: None }
    }

    /// Adds the joint angles of a cycle, rad. `period` is the time since the previous cycle, s.
    pub fn note(&mut self, joints: &Vector3<f64>, period: f64) {
        self.samples += 1.0;
        self.sum += joints;
        let settled = self.smoothing / period;
        // Until the filter has settled, `smoothed` is the mean of all samples. When the filter settles, this mean has
        // about as little noise as the filter.
        self.smoothed += (joints - self.smoothed) / self.samples.min(settled);
        if self.samples >= settled {
            let (lowest, highest) = self.extremes.unwrap_or((self.smoothed, self.smoothed));
            self.extremes = Some((lowest.inf(&self.smoothed), highest.sup(&self.smoothed)));
        }
    }

    /// Returns the number (0 to 2) of the joint that deviates most from its mean, and the deviation, rad. Returns
    /// `None` if no joint deviates by more than [`TOLERANCE`].
    pub fn moved(&self) -> Option<(usize, f64)> {
        let (lowest, highest) = self.extremes?;
        let mean = self.sum / self.samples;
        let (joint, distance) = (highest - mean).sup(&(mean - lowest)).argmax();
        (distance > TOLERANCE).then_some((joint, distance))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Moves joint 1 along `path` (rad, as a function of the time in s) for 0.3 s at 1000 Hz, and returns the result of
    /// `Standstill::moved`.
    fn moved(path: impl Fn(f64) -> f64) -> Option<(usize, f64)> {
        let mut standstill = Standstill::default();
        for cycle in 0..300 {
            standstill.note(&Vector3::new(0.3, path(f64::from(cycle) * 1e-3), -0.2), 1e-3);
        }
        standstill.moved()
    }

    #[test]
    fn oscillation_and_slow_drift_do_not_count_as_motion() {
        assert_eq!(moved(|_| 0.5), None);
        assert_eq!(moved(|seconds| 0.5 + 0.005 * (seconds * 600.0).sin()), None);
        assert_eq!(moved(|seconds| 0.5 + 0.012 * seconds), None);
    }

    #[test]
    fn a_step_a_drift_and_a_bump_count_as_motion() {
        let step = |seconds: f64| if seconds > 0.25 { 0.51 } else { 0.5 };
        assert!(matches!(moved(step), Some((1, distance)) if distance > 0.006), "{:?}", moved(step));
        assert!(matches!(moved(|seconds| 0.5 + 0.05 * seconds), Some((1, _))));
        let bump = |seconds: f64| if (0.1..0.13).contains(&seconds) { 0.49 } else { 0.5 };
        assert!(matches!(moved(bump), Some((1, _))), "{:?}", moved(bump));
    }
}
