//! From a configuration to the numbers of state feedback: one procedure, nothing tuned for a finger by hand.
//!
//! What has a unit follows from the configuration: masses from rotor inertias, the observers' gains from the sizes of a count
//! and a bandwidth. What remains has no unit, or is one in cycles, and was searched on the eigenvalues of the exact one-cycle
//! map of the default finger, never for a pose.

use super::usable::{not_negative, positive};
use crate::model::configuration::{ConfiguredController, Unusable};

/// Frequencies are those of `rate`, and scale with the rate of the finger.
#[derive(Clone, Copy, Debug)]
pub(super) struct Numbers {
    /// alpha: tension commanded for a tension error; the motors feel 1/alpha of their inertia.
    pub inertia_gain: f64,
    /// zeta of the spring.
    pub damping_ratio: f64,
    /// zeta of motors against links.
    pub relative_damping: f64,
    /// rad/s, of the observed disturbance.
    pub disturbance_bandwidth: f64,
    /// rad/s, of the observed links.
    pub link_bandwidth: f64,
    /// Cycles beyond the next sample that the law looks ahead.
    pub ahead: f64,
    /// Least frequency that is damped, rad/s.
    pub least_frequency: f64,
    /// The lag of the tensions, and the inertia of the motors, that the spring's damping reckons with, over what
    /// alpha makes of them.
    pub lag: f64,
    pub felt: f64,
    /// alpha and the damping of motors against links for what the tendons have in common, over those for what turns the joints:
    /// motors that are not alike turn the one into the other.
    pub common_gain: f64,
    pub common_damping: f64,
    /// Rate of fed forward joint friction over the spring's damping, at most: friction that is believed too large must not undo
    /// the damping.
    pub rubbing: f64,
    /// s, of each pole of the reference.
    pub reference_time: f64,
    /// Amplitude of the dither over the joints' Coulomb friction, and its frequency, Hz: the lower it is, the less a motor must
    /// give for it, and the more the tip moves.
    pub dither: f64,
    pub dither_frequency: f64,
}

/// rad/s, damped however soft the finger. With 12 a finger without stiffness swings at its joint limits.
const LEAST_FREQUENCY: f64 = 4.0;

/// Hz.
const DITHER_FREQUENCY: f64 = 40.0;

/// See [`Numbers::rubbing`].
const RUBBING: f64 = 0.4;

/// Rate, Hz, then alpha, zeta, relative zeta, disturbance and link bandwidth (radians a cycle), ahead, lag, common gain, common
/// damping, felt, reference time (s).
type Row = (f64, [f64; 11]);

const TABLE: [Row; 3] = [
    (500.0, [0.95, 0.42, 0.19, 48.0, 2.6, -0.6, 0.04, 0.2, 0.6, 1.4, 0.012]),
    (1000.0, [2.3, 0.178, 0.31, 13.0, 1.634, -0.12, 0.015, 0.043, 0.266, 10.2, 0.008]),
    (2000.0, [3.58, 0.274, 0.557, 15.45, 0.57, -0.359, 0.042, 0.095, 0.184, 9.03, 0.008]),
];

impl Numbers {
    /// What is configured; the rest from the table, between its rates by ratio.
    pub fn new(configured: &ConfiguredController, rate: f64) -> Result<Self, Unusable> {
        let [
            inertia_gain,
            damping_ratio,
            relative_damping,
            disturbance,
            link,
            ahead,
            lag,
            common_gain,
            common_damping,
            felt,
            reference_time,
        ] = row_at(rate);
        let numbers = Self {
            inertia_gain: configured.inertia_gain.unwrap_or(inertia_gain),
            damping_ratio: configured.damping_ratio.unwrap_or(damping_ratio),
            relative_damping,
            disturbance_bandwidth: disturbance * rate,
            link_bandwidth: link * rate,
            ahead,
            lag,
            felt,
            common_gain,
            common_damping,
            rubbing: RUBBING,
            least_frequency: LEAST_FREQUENCY,
            reference_time: configured.set_point_time.unwrap_or(reference_time / (rate / TABLE[0].0).min(1.0)),
            dither: configured.dither.unwrap_or(2.0),
            dither_frequency: DITHER_FREQUENCY.min(rate / 12.0),
        };
        positive("controller.inertia_gain", &[numbers.inertia_gain])?;
        positive("controller.damping_ratio", &[numbers.damping_ratio])?;
        positive("controller.set_point_time", &[numbers.reference_time])?;
        not_negative("controller.dither", numbers.dither)?;
        Ok(numbers)
    }
}

/// The row of `rate`: from row to row every number changes by a power of the rate. In proportion to its logarithm, some poses were
/// unstable at 667 Hz. Beyond its ends the table goes on with its first or last row, so with the same motion in a cycle.
fn row_at(rate: f64) -> [f64; 11] {
    let next = TABLE.iter().position(|row| rate < row.0).unwrap_or(TABLE.len() - 1).max(1);
    let (lower, upper) = (&TABLE[next - 1], &TABLE[next]);
    let part = ((rate / lower.0).ln() / (upper.0 / lower.0).ln()).clamp(0.0, 1.0);
    std::array::from_fn(|number| lower.1[number] * (upper.1[number] / lower.1[number]).powf(part))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rate_has_numbers_of_its_own() {
        for (rate, row) in TABLE {
            for (found, tabulated) in row_at(rate).into_iter().zip(row) {
                assert!((found / tabulated - 1.0).abs() < 1e-12, "{rate} Hz: {found} for {tabulated}");
            }
        }
        assert_eq!(row_at(100.0), TABLE[0].1);
        assert_eq!(row_at(9e3), row_at(2000.0));
        // Half way by ratio: the geometric mean.
        let (lower, upper) = (TABLE[0].1[0], TABLE[1].1[0]);
        assert!((row_at(500.0 * 2f64.sqrt())[0] / (lower * upper).sqrt() - 1.0).abs() < 1e-12);
    }
}
