//! Detects from the gauge of a slack tendon that its motor has wound it taut.
//!
//! The detection must be early, because the tension pushes a free finger from its pose. Single samples are too noisy,
//! so a cumulative sum collects what the samples show above the tare. It detects a small tension after several samples
//! and a large one after a single sample.

use serde::{Deserialize, Serialize};

/// In each sample, the cumulative sum ignores this much of the tension above the tare, in multiples of the noise. The
/// sum therefore stays near zero while the tendon is slack.
const IGNORED: f64 = 1.5;
/// Sum at which the tendon is taut, in multiples of the noise. With `IGNORED` it gives one false detection in about
/// 1e8 samples of Gaussian noise.
const DETECTED: f64 = 6.0;

/// Smallest assumed noise, as a fraction of t_min. A gauge without noise still shows the steps of its converter.
const LEAST_NOISE: f64 = 0.005;
/// Largest assumed noise, as a fraction of t_min.
const MOST_NOISE: f64 = 0.05;

/// If more than this fraction of all samples equals the lowest sample, the converter clips the noise below zero
/// tension.
const CLIPPED: f64 = 0.3;
/// Standard deviation of Gaussian noise, divided by the standard deviation of its positive part: 1.71, rounded up.
const UNCLIPPED: f64 = 1.75;
/// If the clipped fraction of the samples is not above [`CLIPPED`], the standard deviation of the samples is multiplied
/// by 1 plus this multiple of the fraction. The product is the standard deviation of the Gaussian noise.
const PARTLY_CLIPPED: f64 = 1.1;

/// The tare exceeds the smoothed tension by at most this multiple of the noise. If the smoothed tension falls further
/// below the tare, the tare falls too.
const LOWER: f64 = 0.8;

/// The gauge of one tendon. Tensions are in N.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(super) struct Gauge {
    samples: f64,
    sum: f64,
    sum_of_squares: f64,
    lowest: f64,
    /// Number of samples that equal `lowest`.
    at_lowest: f64,
    /// Mean tension before the motor moved, lowered since then if the smoothed tension has fallen (see [`LOWER`]). It
    /// is the error of the gauge's zero if the tendon was slack.
    pub tare: f64,
    /// Root-mean-square noise.
    pub noise: f64,
    /// Cumulative sum, in multiples of the noise.
    sum_above: f64,
    /// Travel of the motor at the last sample before the sum rose, m.
    onset: f64,
}

impl Gauge {
    /// Converts the stored travel to another motor radius. `longer` is the new radius divided by the old one.
    pub fn scale_travel(&mut self, longer: f64) {
        self.onset *= longer;
    }

    /// Reads a sample while the motor is at rest. `minimum` is t_min.
    pub fn tare(&mut self, tension: f64, minimum: f64) {
        if self.samples == 0.0 || tension < self.lowest {
            (self.lowest, self.at_lowest) = (tension, 0.0);
        }
        self.at_lowest += f64::from(tension == self.lowest);
        self.samples += 1.0;
        self.sum += tension;
        self.sum_of_squares += tension * tension;
        self.tare = self.sum / self.samples;
        let deviation = (self.sum_of_squares / self.samples - self.tare * self.tare).max(0.0).sqrt();
        let clipped = self.at_lowest / self.samples;
        let ratio = if clipped > CLIPPED { UNCLIPPED } else { 1.0 + PARTLY_CLIPPED * clipped };
        self.noise = (deviation * ratio).clamp(LEAST_NOISE * minimum, MOST_NOISE * minimum);
    }

    /// Reads a sample while the motor winds in. `smoothed` is the low-pass filtered tension. `travel` is the travel of
    /// the motor, m. Returns the travel at which the tendon came taut, as soon as this is detected.
    pub fn taut_at(&mut self, tension: f64, smoothed: f64, travel: f64) -> Option<f64> {
        self.tare = self.tare.min(smoothed + LOWER * self.noise);
        let above = tension - self.tare;
        self.sum_above = (self.sum_above + above / self.noise - IGNORED).max(0.0);
        if self.sum_above == 0.0 {
            self.onset = travel;
        }
        (self.sum_above > DETECTED).then_some(self.onset)
    }

    /// Returns whether a smoothed tension is above the noise.
    pub fn is_above_noise(&self, smoothed: f64) -> bool {
        smoothed - self.tare > self.noise
    }

    /// Returns whether the tare and the noise are known.
    pub fn is_tared(&self) -> bool {
        self.samples > 0.0
    }

    /// Starts a new detection with the same tare. `travel` is the travel of the motor, m.
    pub fn restart(&mut self, travel: f64) {
        (self.sum_above, self.onset) = (0.0, travel);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64;
    use rand_pcg::rand_core::SeedableRng;

    const MINIMUM: f64 = 5.0;
    const STEP: f64 = 0.0244;

    /// Returns the tension that a gauge shows, N, rounded to a count of its converter. `noise` is in N rms. If
    /// `negative` is false, the converter shows no tension below zero.
    fn shown(tension: f64, noise: f64, negative: bool, random: &mut Pcg64) -> f64 {
        let sample: f64 = StandardNormal.sample(random);
        let shown = ((tension + noise * sample) / STEP).round() * STEP;
        if negative { shown } else { shown.max(0.0) }
    }

    #[test]
    fn noise_is_not_a_taut_tendon() {
        let mut random = Pcg64::seed_from_u64(3);
        let quiet = [(0.0, 0.0), (0.01, 0.0), (0.03, 0.0), (0.09, 0.0), (0.1, 0.05), (0.1, 0.1), (0.1, 0.2)];
        let negative = [(0.03, 0.0), (0.09, 0.0)];
        let cases = quiet.map(|case| (case, false)).into_iter().chain(negative.map(|case| (case, true)));
        for ((noise, offset), negative) in cases {
            for _ in 0..50 {
                let mut gauge = Gauge::default();
                (0..100).for_each(|_| gauge.tare(shown(offset, noise, negative, &mut random), MINIMUM));
                for _ in 0..5000 {
                    let tension = shown(offset, noise, negative, &mut random);
                    let taut = gauge.taut_at(tension, offset, 0.0);
                    assert!(taut.is_none(), "{noise} N about {offset} N, {negative}: {gauge:?}");
                }
            }
        }
    }

    /// A motor that winds in at 2 mm/s raises the tension of a tendon of 30 kN/m by 0.06 N in a period of 1 ms.
    #[test]
    fn a_taut_tendon_is_detected_within_seven_periods() {
        let mut random = Pcg64::seed_from_u64(4);
        for _ in 0..200 {
            let mut gauge = Gauge::default();
            (0..100).for_each(|_| gauge.tare(shown(0.0, 0.03, false, &mut random), MINIMUM));
            let found = (1..8).find_map(|period| {
                let tension = shown(0.06 * f64::from(period), 0.03, false, &mut random);
                gauge.taut_at(tension, 0.0, f64::from(period) * 2e-6)
            });
            assert!(found.is_some_and(|travel| travel < 8e-6), "{found:?}");
        }
    }
}
