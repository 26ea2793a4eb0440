//! The numbers of state feedback. One procedure computes them from the configuration, and nothing is tuned by hand for
//! a finger.
//!
//! Numbers with a unit follow from the configuration: masses from rotor inertias, and the observers' gains from the
//! size of a count and a bandwidth. The other numbers are dimensionless or in radians per cycle. They were found by a
//! search on the eigenvalues of the exact one-cycle map of the default finger, never for a single pose.

use crate::control::number_checks::{not_negative, positive};
use crate::control::rate_table::{Row, Tuned, at};
use crate::model::configuration::{ConfiguredController, Unusable};

/// The numbers at the rate of the finger.
#[derive(Clone, Copy, Debug)]
pub(super) struct Numbers {
    /// alpha: commanded tension for a tension error. The motors appear to have 1/alpha of their inertia.
    pub inertia_gain: f64,
    /// zeta of the spring, relative to the inertia for which the damping is designed.
    pub damping_ratio: f64,
    /// zeta of the motion of the motors relative to the links.
    pub relative_damping: f64,
    /// Bandwidth of the observed disturbance, rad/s.
    pub disturbance_bandwidth: f64,
    /// Bandwidth of the observed links, rad/s.
    pub link_bandwidth: f64,
    /// Time relative to the next sample for which the motion is computed, cycles. Negative is before the sample.
    pub sample_offset: f64,
    /// Least frequency for which the damping is designed, rad/s.
    pub least_frequency: f64,
    /// Lag of the tensions, and inertia of the motors, for which the spring's damping is designed. Both are relative to
    /// the values that follow from alpha.
    pub lag: f64,
    pub damped_inertia: f64,
    /// alpha and relative damping for the common component of the tendons, divided by those for the components that
    /// turn the joints. Differences between motors convert the common component to joint torque.
    pub common_gain: f64,
    pub common_damping: f64,
    /// Largest slope of the joint friction feed-forward, as a fraction of the spring's damping. An overestimated
    /// friction must not cancel the damping.
    pub friction_slope: f64,
    /// Time constant of each pole of the reference, s.
    pub reference_time: f64,
    /// Amplitude of the dither divided by the joints' Coulomb friction, and its frequency, Hz. With a lower frequency
    /// the motors need less torque for the dither, and the tip moves more.
    pub dither: f64,
    pub dither_frequency: f64,
}

/// Least damped frequency, rad/s. It also applies to a finger without stiffness. With 12 such a finger oscillates at
/// its joint limits.
const LEAST_FREQUENCY: f64 = 4.0;

/// Frequency of the dither, Hz.
const DITHER_FREQUENCY: f64 = 40.0;

/// See [`Numbers::friction_slope`].
const FRICTION_SLOPE: f64 = 0.4;

/// The numbers that the table contains for several rates. Fields without a comment are those of [`Numbers`].
#[derive(Clone, Copy)]
struct TunedNumbers {
    inertia_gain: f64,
    damping_ratio: f64,
    relative_damping: f64,
    /// Bandwidth of the observed disturbance, radians per cycle.
    disturbance: f64,
    /// Bandwidth of the observed links, radians per cycle.
    link: f64,
    /// Time before the next sample for which the motion is computed, cycles.
    look_back: f64,
    lag: f64,
    common_gain: f64,
    common_damping: f64,
    damped_inertia: f64,
    /// Time constant of each pole of the reference, s.
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
            look_back: number(lower.look_back, upper.look_back),
            lag: number(lower.lag, upper.lag),
            common_gain: number(lower.common_gain, upper.common_gain),
            common_damping: number(lower.common_damping, upper.common_damping),
            damped_inertia: number(lower.damped_inertia, upper.damped_inertia),
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
            look_back: 0.6,
            lag: 0.04,
            common_gain: 0.2,
            common_damping: 0.6,
            damped_inertia: 1.4,
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
            look_back: 0.12,
            lag: 0.015,
            common_gain: 0.043,
            common_damping: 0.266,
            damped_inertia: 10.2,
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
            look_back: 0.359,
            lag: 0.042,
            common_gain: 0.095,
            common_damping: 0.184,
            damped_inertia: 9.03,
            reference_time: 0.008,
        },
    ),
];

impl Numbers {
    /// Returns the numbers at `rate`, Hz. Numbers that are not configured come from the table.
    pub fn new(configured: &ConfiguredController, rate: f64) -> Result<Self, Unusable> {
        let tuned = at(&TABLE, rate);
        let numbers = Self {
            inertia_gain: configured.inertia_gain.unwrap_or(tuned.inertia_gain),
            damping_ratio: configured.damping_ratio.unwrap_or(tuned.damping_ratio),
            relative_damping: tuned.relative_damping,
            disturbance_bandwidth: tuned.disturbance * rate,
            link_bandwidth: tuned.link * rate,
            sample_offset: -tuned.look_back,
            lag: tuned.lag,
            damped_inertia: tuned.damped_inertia,
            common_gain: tuned.common_gain,
            common_damping: tuned.common_damping,
            friction_slope: FRICTION_SLOPE,
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
