//! The parameters of state feedback ([`Numbers`]). They depend only on the servo rate and the keys of
//! `[finger.controller]`. Without these keys, all fingers with the same rate have the same parameters, so no finger
//! needs parameters that are tuned by hand.
//!
//! The masses of the motors and the gains of the observers are not among these numbers: `construction` computes them.
//! The numbers are tuned. Most of them are dimensionless, or their unit is cycles or radians per cycle. Many were found
//! by a search on the eigenvalues of the exact one-cycle map of the default finger and of fingers that differ from it;
//! the comments and docs/stiffness.md give the reasons for the others. No number was tuned for a single pose. `cargo
//! bench --bench stiffness -- --search` searches for the numbers of a set of fingers. A name in quotes, such as "worn",
//! is a value of `simulation.hand`. An identified finger uses the values that a calibration has found.

use crate::control::number_checks::{not_negative, positive};
use crate::control::rate_table::{Row, Tuned, at};
use crate::model::configuration::{ConfiguredController, Unusable};
use serde::{Deserialize, Serialize};

/// The parameters of state feedback for a finger at its servo rate.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Numbers {
    /// alpha: the gain from the tension error to the pull of a motor. The motors appear to have 1/alpha of their
    /// inertia.
    pub inertia_gain: f64,
    /// Damping ratio of the spring. It applies to the inertia of the links plus the inertia of the motors for which the
    /// damping is designed ([`Numbers::damped_inertia`]).
    pub damping_ratio: f64,
    /// Damping ratio of the motion of the motors relative to the links.
    pub relative_damping: f64,
    /// Bandwidth with which the observers follow the disturbance of the motors, rad/s.
    pub disturbance_bandwidth: f64,
    /// Bandwidth with which the observers follow the motion of the links, rad/s.
    pub link_bandwidth: f64,
    /// Moment for which the motion is computed, relative to the next sample, cycles. It is negative for a moment before
    /// the sample.
    pub sample_offset: f64,
    /// Lowest frequency for which the damping is designed, rad/s.
    pub least_frequency: f64,
    /// The spring's damping is designed for tensions that lag by this time, relative to c / (alpha k). Here, c is the
    /// damping that follows from [`Numbers::relative_damping`], and k the stiffness of a tendon.
    pub lag: f64,
    /// The spring's damping is designed for motors of this inertia, relative to R m R^T / alpha. Here, R are the moment
    /// arms, and m the masses of the motors at the tendons.
    pub damped_inertia: f64,
    /// Natural frequency of the common component of the tensions, rad/s. This component is proportional to the null
    /// vector of R and causes no joint torque. With a higher frequency, differences between motors convert more of it
    /// to joint torque.
    pub common_frequency: f64,
    /// Damping ratio of the common component of the tensions.
    pub common_damping_ratio: f64,
    /// Largest slope of the joint friction feed-forward, as a fraction of the spring's damping. An overestimated
    /// friction must not cancel the damping.
    pub friction_slope: f64,
    /// Time constant of each stage of the reference filter, s.
    pub reference_time: f64,
    /// Amplitude of the dither, divided by the joints' Coulomb friction.
    pub dither: f64,
    /// Smallest amplitude of the dither of the tensions as a fraction of the tension. 0: no dither of the tensions.
    pub tension_dither: f64,
    /// Amplitude to which the dither of each tension rises after a motion of the reference, as a fraction of this
    /// tension at zero joint torque.
    pub dither_burst: f64,
    /// The part of the motors' friction that is fed forward.
    pub friction_share: f64,
    /// Frequency of the dither, Hz. With a lower frequency the motors need less torque for the dither, and the tip
    /// moves more.
    pub dither_frequency: f64,
    /// Amplitude of the dither of the tensions, divided by the configured pulley friction p t. Here, t is the tension,
    /// and p a configured fraction.
    pub pulley_excess: f64,
    /// The tensions keep a distance from t_min, which makes room for the dither. This number is the distance as a
    /// fraction of t_min, divided by the relative amplitude of the dither of the tensions.
    pub dither_reserve: f64,
    /// Largest amplitude of the dither of the tensions, divided by its amplitude at t_min without joint torque. The
    /// limit applies if the configured pulley friction does not require a larger dither. The motors of a loaded finger
    /// follow the dither differently, because friction grows with the tension. The difference moves the joints.
    pub dither_rise: f64,
    /// Bandwidth of the low-pass filter on the drift, rad/s. The drift is the joint rates minus the rates of the
    /// reference. Dither and noise are above this bandwidth, and the motion under a push is below it.
    pub drift_bandwidth: f64,
    /// The part of the pulleys' friction that is fed forward while the reference moves.
    pub pulley_share: f64,
    /// Speed of a tendon, m/s, from which [`Numbers::pulley_share`] is fed forward in full. Below this speed, the
    /// feed-forward is proportional to the speed. The speed is the one that the tendon would have if the joints
    /// followed the reference exactly.
    pub pulley_creep: f64,
    /// Additional tension of a tendon that creeps while the reference is at rest, divided by the friction p t of its
    /// pulleys and by its speed, s/m.
    pub creep_slope: f64,
    /// Bandwidth of the low-pass filter on the speed of a tendon that creeps, rad/s. Dither and noise are above this
    /// bandwidth.
    pub creep_bandwidth: f64,
    /// Largest additional stiffness during a fast motion of the reference, as a share of R k R^T. 0: the stiffness does
    /// not change.
    pub stiffening: f64,
    /// Replaces [`Numbers::stiffening`] if the friction of the pulleys is known, and is therefore fed forward.
    pub identified_stiffening: f64,
}

/// Lowest frequency for which the damping is designed, rad/s. It determines the damping of a finger without stiffness.
/// With 12 rad/s, a finger without stiffness oscillates at its joint limits.
const LEAST_FREQUENCY: f64 = 4.0;

/// Frequency of the dither, Hz. With 40 Hz, fingers with links of half the mass or with amplifiers that lag by 2 ms
/// move by up to 59 um rms at rest, because the dither excites their slow modes. With 50 Hz, fingers with rotors of
/// half the inertia or with slow amplifiers move by 180 to 330 um rms at walls.
const DITHER_FREQUENCY: f64 = 44.0;

/// See [`Numbers::dither`]. With 2, fingers with amplifiers that lag by 2 ms move more at rest. With 1, fingers with
/// static friction of twice the Coulomb friction are less exact under pushes.
const DITHER: f64 = 1.6;

/// See [`Numbers::tension_dither`]. With 0.06, a finger comes to rest even if its motors have no friction, or static
/// friction of twice the Coulomb friction. With 0.1, the tensions of a finger with rotors of half the inertia
/// oscillate.
const TENSION_DITHER: f64 = 0.06;

/// See [`Numbers::pulley_excess`]. An amplitude of p t would suffice at rest. With a larger amplitude the tendons slide
/// during most of a dither period, so that the finger settles within some periods after a push or a step.
const PULLEY_EXCESS: f64 = 5.0;

/// See [`Numbers::dither_reserve`]. A larger reserve raises the pretension. Besides making room for the dither, this
/// makes the tensions more nearly proportional to the null vector of R.
const DITHER_RESERVE: f64 = 16.0 / 3.0;

/// See [`Numbers::dither_rise`].
const DITHER_RISE: f64 = 2.0;

/// See [`Numbers::drift_bandwidth`].
const DRIFT_BANDWIDTH: f64 = 60.0;

/// See [`Numbers::pulley_share`]. With 0.7, steps of identified "worn" fingers settle in 114 instead of 102 ms.
/// [`IDENTIFIED_STIFFENING`] was 0.02 in this comparison.
const PULLEY_SHARE: f64 = 0.8;

/// See [`Numbers::pulley_creep`]. The dither of the tensions keeps the tendons sliding on their pulleys, so the mean
/// friction is small when the joints are slow. With 0.002 and a share of 0.7, steps of identified "sheathed" fingers
/// overshoot by 5.3 instead of 2.6 %, and steps with a pulley friction of 10 % by 14.6 instead of 5.2 %. With 0.03, the
/// slowest steps of "sheathed" fingers settle in 148 ms.
const PULLEY_CREEP: f64 = 0.01;

/// See [`Numbers::creep_slope`]. With 40, fingers are more exact, but a finger whose friction has vanished since it was
/// identified moves by up to 104 um rms at walls.
const CREEP_SLOPE: f64 = 25.0;

/// See [`Numbers::creep_bandwidth`].
const CREEP_BANDWIDTH: f64 = 20.0;

/// See [`Numbers::stiffening`].
const STIFFENING: f64 = 0.07;
/// See [`Numbers::identified_stiffening`]. With 0.02, steps of identified "cheap" fingers overshoot by 4.2 instead of
/// 3.8 %. With 0.07, steps of identified "worn" fingers settle in up to 211 ms.
const IDENTIFIED_STIFFENING: f64 = 0.04;

/// See [`Numbers::friction_share`]. With half of the configured friction, no finger hunted, although the friction of
/// the fingers was 0 to 3 times the configured one.
const FRICTION_SHARE: f64 = 0.5;

/// See [`Numbers::friction_slope`].
const FRICTION_SLOPE: f64 = 0.4;

/// The numbers that the table contains for several rates. A field has the meaning of the field with the same name in
/// [`Numbers`], if there is one.
#[derive(Clone, Copy)]
struct TunedNumbers {
    inertia_gain: f64,
    damping_ratio: f64,
    relative_damping: f64,
    /// Bandwidth with which the observers follow the disturbance of the motors, radians per cycle.
    disturbance: f64,
    /// Bandwidth with which the observers follow the motion of the links, radians per cycle.
    link: f64,
    /// Cycles from the moment for which the motion is computed to the next sample.
    look_back: f64,
    lag: f64,
    /// At 1000 Hz, with 50 rad/s and a ratio of 0.5, tensions of "cheap" fingers fall a second time after a bump.
    common_frequency: f64,
    common_damping_ratio: f64,
    damped_inertia: f64,
    /// Time constant of each stage of the reference filter, s.
    reference_time: f64,
    /// At 1000 Hz, "cheap" fingers settle later with a larger value, and "worn" fingers with a smaller one.
    dither_burst: f64,
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
            common_frequency: number(lower.common_frequency, upper.common_frequency),
            common_damping_ratio: number(lower.common_damping_ratio, upper.common_damping_ratio),
            damped_inertia: number(lower.damped_inertia, upper.damped_inertia),
            reference_time: number(lower.reference_time, upper.reference_time),
            dither_burst: number(lower.dither_burst, upper.dither_burst),
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
            common_frequency: 46.3,
            common_damping_ratio: 0.641,
            damped_inertia: 1.4,
            reference_time: 0.012,
            dither_burst: 0.25,
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
            common_frequency: 55.0,
            common_damping_ratio: 0.75,
            damped_inertia: 10.2,
            reference_time: 0.008,
            dither_burst: 0.35,
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
            common_frequency: 75.0,
            common_damping_ratio: 0.8,
            damped_inertia: 9.03,
            reference_time: 0.008,
            dither_burst: 0.35,
        },
    ),
];

impl Numbers {
    /// Returns the numbers at `rate`, Hz. Numbers that are not configured come from the table or from the constants.
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
            common_frequency: tuned.common_frequency,
            common_damping_ratio: tuned.common_damping_ratio,
            friction_slope: FRICTION_SLOPE,
            least_frequency: LEAST_FREQUENCY,
            reference_time: configured.set_point_time.unwrap_or(tuned.reference_time / (rate / TABLE[0].0).min(1.0)),
            dither: configured.dither.unwrap_or(DITHER),
            tension_dither: configured.tension_dither.unwrap_or(TENSION_DITHER),
            dither_burst: tuned.dither_burst,
            friction_share: configured.friction_share.unwrap_or(FRICTION_SHARE),
            dither_frequency: DITHER_FREQUENCY.min(rate / 12.0),
            pulley_excess: PULLEY_EXCESS,
            dither_reserve: DITHER_RESERVE,
            dither_rise: DITHER_RISE,
            drift_bandwidth: DRIFT_BANDWIDTH,
            pulley_share: PULLEY_SHARE,
            pulley_creep: PULLEY_CREEP,
            creep_slope: CREEP_SLOPE,
            creep_bandwidth: CREEP_BANDWIDTH,
            stiffening: STIFFENING,
            identified_stiffening: IDENTIFIED_STIFFENING,
        };
        positive("controller.inertia_gain", &[numbers.inertia_gain])?;
        positive("controller.damping_ratio", &[numbers.damping_ratio])?;
        positive("controller.set_point_time", &[numbers.reference_time])?;
        not_negative("controller.dither", numbers.dither)?;
        not_negative("controller.tension_dither", numbers.tension_dither)?;
        not_negative("controller.friction_share", numbers.friction_share)?;
        Ok(numbers)
    }
}
