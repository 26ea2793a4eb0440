//! Gains tuned for the default finger, by scheme and rate.

use crate::control::rate_table::{Row, Tuned, at};
use crate::model::configuration::Scheme;

/// The gains that the tables contain for several rates.
/// [`ConfiguredController`](crate::model::configuration::ConfiguredController) documents their meaning and units.
#[derive(Clone, Copy)]
pub(super) struct TunedGains {
    pub tension_gain: f64,
    pub tension_integral: f64,
    pub motor_damping: f64,
    pub rate_time: f64,
    pub speed_filter: f64,
    pub stretch_filter: f64,
}

impl Tuned for TunedGains {
    fn combine(lower: &Self, upper: &Self, number: impl Fn(f64, f64) -> f64) -> Self {
        Self {
            tension_gain: number(lower.tension_gain, upper.tension_gain),
            tension_integral: number(lower.tension_integral, upper.tension_integral),
            motor_damping: number(lower.motor_damping, upper.motor_damping),
            rate_time: number(lower.rate_time, upper.rate_time),
            speed_filter: number(lower.speed_filter, upper.speed_filter),
            stretch_filter: number(lower.stretch_filter, upper.stretch_filter),
        }
    }
}

/// These gains were found by experiments with the default finger.
const FIGURE_9: [Row<TunedGains>; 3] = [
    (
        500.0,
        TunedGains {
            tension_gain: 0.0,
            tension_integral: 50.0,
            motor_damping: 250.0,
            rate_time: 0.020,
            speed_filter: 160.0,
            stretch_filter: 3.0,
        },
    ),
    (
        1000.0,
        TunedGains {
            tension_gain: 0.0,
            tension_integral: 75.0,
            motor_damping: 310.0,
            rate_time: 0.050,
            speed_filter: 180.0,
            stretch_filter: 2.0,
        },
    ),
    (
        2000.0,
        TunedGains {
            tension_gain: 0.0,
            tension_integral: 100.0,
            motor_damping: 440.0,
            rate_time: 0.060,
            speed_filter: 160.0,
            stretch_filter: 5.0,
        },
    ),
];

const FIGURE_10: [Row<TunedGains>; 3] = [
    (
        500.0,
        TunedGains {
            tension_gain: 0.1,
            tension_integral: 55.0,
            motor_damping: 265.0,
            rate_time: 0.020,
            speed_filter: 190.0,
            stretch_filter: 3.0,
        },
    ),
    (
        1000.0,
        TunedGains {
            tension_gain: 2.0,
            tension_integral: 250.0,
            motor_damping: 450.0,
            rate_time: 0.015,
            speed_filter: 400.0,
            stretch_filter: 6.0,
        },
    ),
    (
        2000.0,
        TunedGains {
            tension_gain: 5.0,
            tension_integral: 550.0,
            motor_damping: 460.0,
            rate_time: 0.020,
            speed_filter: 400.0,
            stretch_filter: 6.0,
        },
    ),
];

/// The rows for 500 and 2000 Hz are the best of 50 random rows: those with the smallest worst-case eigenvalue of the
/// one-cycle map over 40 poses at 1, 3 and 6 N/cm.
const FIGURE_11: [Row<TunedGains>; 3] = [
    (
        500.0,
        TunedGains {
            tension_gain: 0.0,
            tension_integral: 0.0,
            motor_damping: 60.0,
            rate_time: 0.020,
            speed_filter: 200.0,
            stretch_filter: 3.0,
        },
    ),
    (
        1000.0,
        TunedGains {
            tension_gain: 0.0,
            tension_integral: 0.0,
            motor_damping: 86.0,
            rate_time: 0.0055,
            speed_filter: 400.0,
            stretch_filter: 20.0,
        },
    ),
    (
        2000.0,
        TunedGains {
            tension_gain: 0.0,
            tension_integral: 0.0,
            motor_damping: 54.0,
            rate_time: 0.0041,
            speed_filter: 385.0,
            stretch_filter: 6.0,
        },
    ),
];

impl TunedGains {
    /// Returns the gains of a scheme at `rate`, Hz.
    pub fn of(scheme: Scheme, rate: f64) -> Self {
        let table = match scheme {
            Scheme::Figure9 => &FIGURE_9,
            // State feedback takes its filters from the table of Figure 10.
            Scheme::Figure10 | Scheme::StateFeedback => &FIGURE_10,
            Scheme::Figure11 => &FIGURE_11,
        };
        at(table, rate)
    }
}
