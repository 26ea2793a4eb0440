//! The highest rate at which a hand meets every deadline.

use super::off_line::{Costs, Scheduled, Sensor, Violation, off_line_schedule};
use serde::Serialize;
use sun2xp::model::configuration::{Configuration, RATES};

/// The highest rate, and what prevents a higher one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Fastest {
    /// The highest whole rate that can be configured and at which every deadline is met, Hz. `None` if there is none.
    pub rate: Option<u32>,
    /// The condition that may be violated at the next whole rate, or at the lowest rate if `rate` is `None`. `None` if
    /// every deadline is met at the highest rate that can be configured.
    pub limit: Option<Limit>,
}

/// A condition that may be violated, and the first thread that may violate it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Limit {
    pub missed: Violation,
    pub thread: u8,
}

impl Fastest {
    pub fn of(hand: &Configuration, costs: &Costs, sensor: &Sensor) -> Self {
        let limit = |rate: u32| limit(&off_line_schedule(hand, rate.into(), costs, sensor));
        let (lowest, highest) = (RATES.start().ceil() as u32, RATES.end().floor() as u32);
        // A lower rate leaves time for more tactile events. With them, a thread may miss a deadline that it meets at a
        // higher rate. So bisection is not valid.
        let rate = (lowest..=highest).rev().find(|&rate| limit(rate).is_none());
        let missed_at = rate.map_or(lowest, |rate| rate + 1);
        Self { rate, limit: if missed_at > highest { None } else { limit(missed_at) } }
    }
}

fn limit(schedule: &[Scheduled]) -> Option<Limit> {
    schedule.iter().find_map(|thread| thread.violation.map(|missed| Limit { missed, thread: thread.thread }))
}
