//! From a configuration to the numbers of state feedback: one procedure, nothing tuned for a finger by hand.
//!
//! What has a unit follows from the configuration: masses from rotor inertias, the observers' gains from the sizes of a
//! count and a bandwidth. What remains has no unit, or is one in cycles, and was searched on the eigenvalues of the
//! exact one-cycle map of the default finger, never for a pose.

use crate::control::number_checks::{not_negative, positive};
use crate::control::rate_table::{Row, Tuned, at};
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
    /// alpha and the damping of motors against links for what the tendons have in common, over those for what turns the
    /// joints: motors that are not alike turn the one into the other.
    pub common_gain: f64,
    pub common_damping: f64,
    /// Rate of fed forward joint friction over the spring's damping, at most: friction that is believed too large must
    /// not undo the damping.
    pub rubbing: f64,
    /// s, of each pole of the reference.
    pub reference_time: f64,
    /// Amplitude of the dither over the joints' Coulomb friction, and its frequency, Hz: the lower it is, the less a
    /// motor must give for it, and the more the tip moves.
    pub dither: f64,
    pub dither_frequency: f64,
}

/// rad/s, damped however soft the finger. With 12 a finger without stiffness swings at its joint limits.
const LEAST_FREQUENCY: f64 = 4.0;

/// Hz.
const DITHER_FREQUENCY: f64 = 40.0;

/// See [`Numbers::rubbing`].
const RUBBING: f64 = 0.4;

/// The numbers that the table has for several rates. What has no unit here is the same as in [`Numbers`].
#[derive(Clone, Copy)]
struct TunedNumbers {
    inertia_gain: f64,
    damping_ratio: f64,
    relative_damping: f64,
    /// Bandwidth of the observed disturbance, radians a cycle.
    disturbance: f64,
    /// Bandwidth of the observed links, radians a cycle.
    link: f64,
    /// Cycles that the law looks back from the next sample.
    behind: f64,
    lag: f64,
    common_gain: f64,
    common_damping: f64,
    felt: f64,
    /// s.
    reference_time: f64,
}

impl Tuned for TunedNumbers {
    fn combine(lower: &Self, upper: &Self, number: impl Fn(f64, f64) -> f64) -> Self {
        Self {
            inertia_gain: number(lower.inertia_gain, upper.inertia_gain),
            damping_ratio: number(lower.damping_ratio, upper.damping_ratio),
            relative_damping: number(lower.relative_damping, upper.relative_damping),
            disturbance: number(lower.disturbance, upper.disturbance),
            link: number(lower.link, upper.link),
            behind: number(lower.behind, upper.behind),
            lag: number(lower.lag, upper.lag),
            common_gain: number(lower.common_gain, upper.common_gain),
            common_damping: number(lower.common_damping, upper.common_damping),
            felt: number(lower.felt, upper.felt),
            reference_time: number(lower.reference_time, upper.reference_time),
        }
    }
}

const TABLE: [Row<TunedNumbers>; 3] = [
    (
        500.0,
        TunedNumbers {
            inertia_gain: 0.95,
            damping_ratio: 0.42,
            relative_damping: 0.19,
            disturbance: 48.0,
            link: 2.6,
            behind: 0.6,
            lag: 0.04,
            common_gain: 0.2,
            common_damping: 0.6,
            felt: 1.4,
            reference_time: 0.012,
        },
    ),
    (
        1000.0,
        TunedNumbers {
            inertia_gain: 2.3,
            damping_ratio: 0.178,
            relative_damping: 0.31,
            disturbance: 13.0,
            link: 1.634,
            behind: 0.12,
            lag: 0.015,
            common_gain: 0.043,
            common_damping: 0.266,
            felt: 10.2,
            reference_time: 0.008,
        },
    ),
    (
        2000.0,
        TunedNumbers {
            inertia_gain: 3.58,
            damping_ratio: 0.274,
            relative_damping: 0.557,
            disturbance: 15.45,
            link: 0.57,
            behind: 0.359,
            lag: 0.042,
            common_gain: 0.095,
            common_damping: 0.184,
            felt: 9.03,
            reference_time: 0.008,
        },
    ),
];

impl Numbers {
    /// What is configured; the rest from the table.
    pub fn new(configured: &ConfiguredController, rate: f64) -> Result<Self, Unusable> {
        let tuned = at(&TABLE, rate);
        let numbers = Self {
            inertia_gain: configured.inertia_gain.unwrap_or(tuned.inertia_gain),
            damping_ratio: configured.damping_ratio.unwrap_or(tuned.damping_ratio),
            relative_damping: tuned.relative_damping,
            disturbance_bandwidth: tuned.disturbance * rate,
            link_bandwidth: tuned.link * rate,
            ahead: -tuned.behind,
            lag: tuned.lag,
            felt: tuned.felt,
            common_gain: tuned.common_gain,
            common_damping: tuned.common_damping,
            rubbing: RUBBING,
            least_frequency: LEAST_FREQUENCY,
            reference_time: configured.set_point_time.unwrap_or(tuned.reference_time / (rate / TABLE[0].0).min(1.0)),
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
