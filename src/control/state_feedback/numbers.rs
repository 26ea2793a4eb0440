//! From a configuration to the numbers of state feedback: one procedure, nothing tuned for a finger by hand.
//!
//! What has a unit follows from the configuration: masses from rotor inertias, the observers' gains from the sizes of a count
//! and a bandwidth. What remains has no unit, or is one in cycles, and was searched on the eigenvalues of the exact one-cycle
//! map of the default finger, never for a pose.

use crate::control::number_checks::{not_negative, positive};
use crate::control::tendons::gains::{Row, at};
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

/// alpha, zeta, relative zeta, disturbance and link bandwidth (radians a cycle), cycles that it looks back, lag, common gain, common damping,
/// felt, reference time (s).
const TABLE: [Row<11>; 3] = [
    (500.0, [0.95, 0.42, 0.19, 48.0, 2.6, 0.6, 0.04, 0.2, 0.6, 1.4, 0.012]),
    (1000.0, [2.3, 0.178, 0.31, 13.0, 1.634, 0.12, 0.015, 0.043, 0.266, 10.2, 0.008]),
    (2000.0, [3.58, 0.274, 0.557, 15.45, 0.57, 0.359, 0.042, 0.095, 0.184, 9.03, 0.008]),
];

impl Numbers {
    /// What is configured; the rest from the table.
    pub fn new(configured: &ConfiguredController, rate: f64) -> Result<Self, Unusable> {
        let [
            inertia_gain,
            damping_ratio,
            relative_damping,
            disturbance,
            link,
            behind,
            lag,
            common_gain,
            common_damping,
            felt,
            reference_time,
        ] = at(&TABLE, rate);
        let numbers = Self {
            inertia_gain: configured.inertia_gain.unwrap_or(inertia_gain),
            damping_ratio: configured.damping_ratio.unwrap_or(damping_ratio),
            relative_damping,
            disturbance_bandwidth: disturbance * rate,
            link_bandwidth: link * rate,
            ahead: -behind,
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
