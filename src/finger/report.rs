//! The servo's report on its finger.

use crate::calibration::Verdict;
use crate::control::events::Arrival;
use crate::control::{Report, SetPoint};
use crate::finger::{Losses, Reference, Stage, Warnings};

/// The data that a servo reports about its finger after every cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingerReport {
    /// Stage of the finger between open and close.
    pub stage: Stage,
    /// The set point in force.
    pub set_point: SetPoint,
    /// Number of the set point in force, which the planners' end of the mailbox has counted.
    pub set_point_number: u32,
    /// Number of the period in which the set point in force took effect. Periods are numbered for the whole hand, from
    /// the start that its servo threads have in common.
    pub set_point_period: u64,
    /// Number of the period of the last cycle.
    pub period: u64,
    /// Number of times that the finger has become a spring: at open, after a fault, after a calibration, or after its
    /// set point has expired. The spring first holds the pose that the finger then has. Set points that were sent
    /// earlier are discarded.
    pub springs: u32,
    /// Whether the finger holds its pose because its set point has expired, and has not followed another one since.
    pub expired: bool,
    /// The controller's report of the last cycle.
    pub cycle: Report,
    /// The reference of the last cycle.
    pub reference: Reference,
    /// Number of the newest controller that the servo has taken from planners. The servo computes with it now, or will
    /// do so after a calibration.
    pub controller: u32,
    /// Number of orders that the servo has taken.
    pub orders: u32,
    /// Verdict of the last calibration, if there was one.
    pub calibration: Option<Verdict>,
    /// Counts since open.
    pub losses: Losses,
    /// Number of recoveries from a fault.
    pub recoveries: u32,
    /// Warnings of the finger.
    pub warnings: Warnings,
    /// Whether the finger has reached the set point in force, and has come to rest.
    pub arrival: Arrival,
    /// Beginning of the first cycle, ns of the monotonic clock.
    pub first: u64,
    /// Beginning of the last cycle, ns of the monotonic clock.
    pub last: u64,
    /// Scheduled beginning of the next cycle, ns of the monotonic clock.
    pub next: u64,
}

impl FingerReport {
    /// Returns the report before the first cycle of a finger that will hold `set_point`.
    pub fn opening(set_point: SetPoint) -> Self {
        Self {
            stage: Stage::Opening,
            set_point,
            set_point_number: 0,
            set_point_period: 0,
            period: 0,
            springs: 0,
            expired: false,
            cycle: Report::default(),
            reference: Reference::default(),
            controller: 0,
            orders: 0,
            calibration: None,
            losses: Losses::default(),
            recoveries: 0,
            warnings: Warnings::default(),
            arrival: Arrival::default(),
            first: 0,
            last: 0,
            next: 0,
        }
    }

    /// Returns the number of whole periods of `period` ns that have passed without a cycle and are not yet counted in
    /// [`Losses::skipped_periods`]. The servo counts them at the end of its next cycle. `now` is in ns of the monotonic
    /// clock.
    pub fn missing_periods(&self, now: u64, period: u64) -> u64 {
        if self.losses.cycles == 0 || self.stage == Stage::Closed {
            return 0;
        }
        // The servo would skip this number of periods if its next cycle ended now.
        now.saturating_sub(self.next + period) / period
    }
}
