//! What a servo reports of its finger.

use crate::calibration::Verdict;
use crate::control::{Report, SetPoint};
use crate::finger::{Losses, Stage, Warnings};

/// What a servo tells of its finger, each cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingerReport {
    /// Where the finger is between open and close.
    pub stage: Stage,
    /// The set point in force.
    pub set_point: SetPoint,
    /// How often it has become a spring that holds the pose it was found in: at open, after a fault, after a
    /// calibration. What was sent before is gone.
    pub springs: u32,
    /// What the last cycle found and decided.
    pub cycle: Report,
    /// Number of the controller that planners have handed over last and the servo has taken: it is computed with, or
    /// will be after a calibration.
    pub controller: u32,
    /// How many orders have been taken.
    pub orders: u32,
    /// What became of the last calibration, if there was one.
    pub calibration: Option<Verdict>,
    /// Since open.
    pub losses: Losses,
    /// How often it has gone on after a fault.
    pub recoveries: u32,
    /// What the finger is warned of.
    pub warnings: Warnings,
    /// When the first cycle began, ns of the monotonic clock.
    pub first: u64,
    /// When the last cycle began, ns of the monotonic clock.
    pub last: u64,
    /// When the next cycle shall begin, ns of the monotonic clock.
    pub next: u64,
}

impl FingerReport {
    /// Whole periods, of `period` ns, that have passed without a cycle and are not counted in
    /// [`Losses::skipped_periods`] yet, because the servo counts at the end of its next cycle. `now`: ns of the
    /// monotonic clock.
    pub fn missing_periods(&self, now: u64, period: u64) -> u64 {
        if self.losses.cycles == 0 || self.stage == Stage::Closed {
            return 0;
        }
        // As many as the servo would skip if its next cycle ended now.
        now.saturating_sub(self.next + period) / period
    }
}
