//! Learns how the tendon stiffnesses, gauge gains and moment arms of a finger differ from the configured values.
//!
//! These errors make gauges and encoders disagree by a sum of seven terms: one for each tendon, in proportion to the
//! change of its tension, and one for each joint, in proportion to its motion. A Kalman filter estimates the factors of
//! the seven terms from the motions of the finger. An offset is its eighth state. At rest the seven terms are constant,
//! so the filter attributes a disagreement that grows at rest to the offset. An error of the configuration is therefore
//! learned, and a drift of a gauge is not.
//!
//! If the finger moves while a gauge drifts, the filter would explain a part of the drift by this motion for a short
//! time. So samples are compared with what was known before the present block of samples, and what the filter learns
//! from a doubtful block is discarded.

use nalgebra::{SMatrix, SVector};

/// The terms of the disagreement, N: four tendons and three joints. A term is the disagreement that a factor of 1
/// causes, and 1 is the expected magnitude of the factors.
pub(super) type Terms = SVector<f64, 7>;

/// The factors of the seven terms, and the offset, N.
type Estimate = SVector<f64, 8>;

/// Period of the estimation, s. The disagreement that friction causes changes slowly, so more samples would not contain
/// more information.
const PERIOD: f64 = 0.01;

/// Variance that the offset gains between two estimations, as a part of the variance of the noise of the disagreement.
/// It makes the offset follow a drift.
const DRIFT: f64 = 0.1;

/// Least noise of the disagreement, N rms: the resolution of encoders and gauges.
const LEAST_NOISE: f64 = 0.03;

/// Gains per estimation with which the variance of the noise rises and falls.
const RISING: f64 = 0.3;
const FALLING: f64 = 0.01;

/// Change of the terms from one estimation to the next, N. The finger counts as moving if the change is larger than
/// this. The noise is learned only while the finger moves: at rest the friction of the tendons does not change, so its
/// magnitude cannot be determined.
const MOVING: f64 = 0.1;

/// Number of estimations in motion before the learned noise counts. In this time most tendons slide in both directions.
const ENOUGH: u32 = 30;

/// Largest disagreement that friction causes, as a multiple of its rms value.
const PEAK: f64 = 10.0;

/// Smallest uncertainty of the factors of the tendons. The stiffness of a tendon that hardens depends on its tension,
/// so no constant factor describes it.
const LEAST: f64 = 0.25;

/// Factor on the variance of what is learned: successive samples have the same friction, so they are not independent.
const CORRELATION: f64 = 4.0;

/// Multiple of the standard deviation of [`Mismatch::explained`] that is tolerated.
pub(super) const DEVIATIONS: f64 = 2.0;

/// Duration of the blocks, s. Samples are compared with what was known one or two blocks before.
const BLOCK: f64 = 0.5;

/// A block is doubtful if the disagreement, divided by the tolerated one, reaches this value in one of its samples.
const DOUBTFUL: f64 = 0.7;

/// What is known of the mismatch of a finger.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Mismatch {
    /// The knowledge that samples are compared with.
    old: Filter,
    /// The knowledge at the beginning of the present block.
    before: Filter,
    now: Filter,
    /// Time since the beginning of the block, s.
    time: f64,
    /// Largest disagreement of the block divided by the tolerated one.
    ratio: f64,
}

impl Mismatch {
    /// Returns the disagreement that the learned factors explain, and its standard deviation, N.
    pub fn explained(&self, terms: &Terms) -> (f64, f64) {
        self.old.explained(terms)
    }

    /// Returns the part of [`Mismatch::explained`] that the term of a tendon, 0 to 3, explains, N.
    pub fn explained_by(&self, tendon: usize, terms: &Terms) -> f64 {
        self.old.estimate[tendon] * terms[tendon]
    }

    /// Returns the disagreement that friction can cause, N. `expected` is the value for an unknown hand. The result is
    /// `expected` until the noise is learned, and at most `expected` afterwards.
    pub fn friction(&self, expected: f64) -> f64 {
        self.old.friction(expected)
    }

    /// Learns from a sample. `ratio` is its disagreement divided by the tolerated one.
    pub fn learn(&mut self, terms: &Terms, disagreement: f64, ratio: f64, elapsed: f64) {
        self.now.learn(terms, disagreement, elapsed);
        self.time += elapsed;
        self.ratio = self.ratio.max(ratio);
        if self.time >= BLOCK {
            if self.ratio < DOUBTFUL {
                (self.old, self.before) = (self.before, self.now);
            } else {
                self.now = self.before;
            }
            (self.time, self.ratio) = (0.0, 0.0);
        }
    }
}

/// The Kalman filter.
#[derive(Clone, Copy, Debug)]
pub(super) struct Filter {
    estimate: Estimate,
    /// Covariance of the estimate, divided by the variance of the noise.
    covariance: SMatrix<f64, 8, 8>,
    /// Variance of the disagreement that the terms do not explain, such as the disagreement that friction causes, N^2.
    noise: f64,
    /// Terms of the last estimation, N.
    terms: Terms,
    /// Number of estimations in motion.
    moved: u32,
    /// Time since the last estimation, s.
    since: f64,
}

impl Default for Filter {
    /// Nothing is known yet.
    fn default() -> Self {
        let noise = LEAST_NOISE * LEAST_NOISE;
        // The standard deviation of the factors is 1. The offset is zero at first.
        let mut covariance = SMatrix::identity() / noise;
        covariance[(7, 7)] = 1.0;
        Self { estimate: Estimate::zeros(), covariance, noise, terms: Terms::zeros(), moved: 0, since: 0.0 }
    }
}

impl Filter {
    fn explained(&self, terms: &Terms) -> (f64, f64) {
        let factors = self.estimate.fixed_rows::<7>(0);
        let covariance = self.covariance.fixed_view::<7, 7>(0, 0);
        let least = LEAST * LEAST * terms.fixed_rows::<4>(0).norm_squared();
        let variance = CORRELATION * self.noise * terms.dot(&(covariance * terms)).max(0.0);
        (factors.dot(terms), (variance.min(terms.norm_squared()) + least).sqrt())
    }

    fn friction(&self, expected: f64) -> f64 {
        if self.moved < ENOUGH { expected } else { expected.min(PEAK * self.noise.sqrt()) }
    }

    fn learn(&mut self, terms: &Terms, disagreement: f64, elapsed: f64) {
        self.since += elapsed;
        if self.since < PERIOD {
            return;
        }
        self.since = 0.0;
        let moved = (terms - std::mem::replace(&mut self.terms, *terms)).norm();
        self.covariance[(7, 7)] += DRIFT;
        let row = terms.push(1.0);
        let spread = self.covariance * row;
        let variance = 1.0 + row.dot(&spread);
        let innovation = disagreement - row.dot(&self.estimate);
        let gain = spread / variance;
        self.estimate += gain * innovation;
        self.covariance -= gain * spread.transpose();
        if moved > MOVING {
            self.moved = self.moved.saturating_add(1);
            let rise = innovation * innovation / variance - self.noise;
            self.noise += rise * if rise > 0.0 { RISING } else { FALLING };
            self.noise = self.noise.max(LEAST_NOISE * LEAST_NOISE);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FACTORS: [f64; 7] = [0.5, -0.3, 0.8, 0.1, -0.6, 0.9, 0.4];

    /// The terms after `seconds` of a motion that excites all of them. The motion stands still in every other second,
    /// and jumps when it begins again.
    fn moving(seconds: f64) -> Terms {
        let moved = seconds.floor() / 2.0 + (seconds.fract() * (seconds as u32 % 2) as f64) / 2.0;
        Terms::from_fn(|term, _| 5.0 * (moved * (1.0 + 0.37 * term as f64)).sin())
    }

    fn disagreement(terms: &Terms) -> f64 {
        terms.dot(&Terms::from(FACTORS))
    }

    #[test]
    fn it_learns_the_factors_from_motion_and_then_explains_other_poses() {
        let mut mismatch = Mismatch::default();
        for sample in 0..20_000 {
            let terms = moving(f64::from(sample) * 1e-3);
            mismatch.learn(&terms, disagreement(&terms), 0.0, 1e-3);
        }
        let elsewhere = Terms::from([4.0, -3.0, 1.0, 2.0, 5.0, -2.0, 3.0]);
        let (explained, deviation) = mismatch.explained(&elsewhere);
        let error = explained - disagreement(&elsewhere);
        assert!(error.abs() < 0.3 && deviation < 1.5, "{error} {deviation}");
    }

    #[test]
    fn it_does_not_explain_a_drift() {
        let mut mismatch = Mismatch::default();
        for sample in 0..30_000 {
            let seconds = f64::from(sample) * 1e-3;
            let terms = moving(seconds);
            let drift = (seconds - 20.0).max(0.0) * 0.5;
            mismatch.learn(&terms, disagreement(&terms) + drift, 0.0, 1e-3);
        }
        let terms = moving(30.0);
        let left = disagreement(&terms) + 5.0 - mismatch.explained(&terms).0;
        assert!((left - 5.0).abs() < 1.0, "{left}");
    }
}
