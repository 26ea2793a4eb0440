//! Counts of the servo's timing and communication errors.

use serde::{Deserialize, Serialize};

/// Counts of a finger's cycles, and of the errors in them.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct Losses {
    /// Number of cycles.
    pub cycles: u64,
    /// Cycles that ended after the next one should have begun.
    pub overruns: u64,
    /// Whole periods in which no cycle began because the previous cycle was late or the servo thread did not run.
    pub skipped_periods: u64,
    /// Cycles without a valid reply in time.
    pub lost_replies: u64,
    /// Replies that arrived after the end of their cycle.
    pub late_replies: u64,
    /// Replies that arrived twice.
    pub duplicate_replies: u64,
    /// Byte sequences on the finger's port that were not valid frames.
    pub damaged_frames: u64,
    /// Valid frames on the finger's port that no finger waited for.
    pub foreign_frames: u64,
}

impl Losses {
    /// Returns the counts since `earlier`.
    #[must_use]
    pub fn since(&self, earlier: &Self) -> Self {
        Self {
            cycles: self.cycles - earlier.cycles,
            overruns: self.overruns - earlier.overruns,
            skipped_periods: self.skipped_periods - earlier.skipped_periods,
            lost_replies: self.lost_replies - earlier.lost_replies,
            late_replies: self.late_replies - earlier.late_replies,
            duplicate_replies: self.duplicate_replies - earlier.duplicate_replies,
            damaged_frames: self.damaged_frames - earlier.damaged_frames,
            foreign_frames: self.foreign_frames - earlier.foreign_frames,
        }
    }
}
