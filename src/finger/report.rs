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
    /// Number of the set point in force. The planners' end of the mailbox numbers the set points.
    pub set_point_number: u32,
    /// Number of the period in which the set point in force took effect. All servo threads of the hand number their
    /// periods from the same start.
    pub set_point_period: u64,
    /// Number of the period of the last cycle.
    pub period: u64,
    /// Number of the spring phase: a time in which the fingertip behaves as a spring and follows set points without an
    /// interruption. A new phase begins when the finger enters the stage `Running`: at open, and after a fault or a
    /// calibration. It also begins when a set point expires, when a reflex reacts, and when the inhibition ends. The
    /// inhibition is the time after a reaction in which the finger does not follow its planner. Changes that planners
    /// send in the new phase start from the set point that the servo holds then. Set points that were sent in an
    /// earlier phase are discarded, except those of a phase that ended because its set point expired.
    pub springs: u32,
    /// Whether the finger holds its pose because its set point has expired, and has not followed another one since.
    pub expired: bool,
    /// Number of the spring phase that ended when the last set point expired. A set point for this phase is still
    /// accepted, because the planner may have sent it before it learned of the expiry.
    pub expired_phase: Option<u32>,
    /// The controller's report of the last cycle.
    pub cycle: Report,
    /// The reference of the last cycle.
    pub reference: Reference,
    /// Number of the newest controller that the servo has received from planners. The servo uses this controller now,
    /// or will use it after the calibration that is running.
    pub controller: u32,
    /// Number of orders (`Order`) that the servo has received.
    pub orders: u32,
    /// Verdict of the last calibration, if there was one.
    pub calibration: Option<Verdict>,
    /// Numbers of cycles, and of timing and communication errors, since open.
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
            expired_phase: None,
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
