//! What a servo could not do in time, counted.

/// How many cycles a finger had, and what went wrong in them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Losses {
    /// Cycles.
    pub cycles: u64,
    /// Cycles that were not over when the next one should have begun.
    pub overruns: u64,
    /// Periods skipped because of that.
    pub skipped_periods: u64,
    /// Cycles without a valid reply in time.
    pub lost_replies: u64,
    /// Replies that came when their cycle was over.
    pub late_replies: u64,
    /// Replies that came once more.
    pub duplicate_replies: u64,
    /// Pieces of bytes on the finger's port that were no frame.
    pub damaged_frames: u64,
    /// Whole frames on the finger's port that nobody waited for.
    pub foreign_frames: u64,
}

impl Losses {
    /// Since `earlier`.
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
