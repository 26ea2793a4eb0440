//! The black boxes of an open hand.

use crate::finger::{CycleRecord, KeptRecord, Recording};
use crate::hand::black_box_file::save_recording;
use crate::hand::{Hand, HandError};
use crate::model::FingerNumber;
use std::path::Path;

impl Hand {
    /// The last two seconds of finger 1, 2 or 3. For a faulted finger they are the last two seconds before the fault.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if it has no cycle yet.
    pub fn recording(&self, finger: i32) -> Result<Recording, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.dispatcher.recording(finger)?.ok_or(HandError::NoAnswer(finger))
    }

    /// The record of a cycle of finger 1, 2 or 3, or of its newest cycle if `cycle` is `None`. The black box holds the
    /// cycles of the last two seconds.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if the cycle is not in the black box.
    pub fn record(&self, finger: i32, cycle: Option<u64>) -> Result<KeptRecord, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.dispatcher.record(finger, cycle)?.ok_or(HandError::NoRecord { finger, cycle: cycle.unwrap_or_default() })
    }

    /// Appends to `records` the records of all cycles of finger 1, 2 or 3 that are later than `cycle`, in their order.
    /// Cycles that are older than two seconds are missing, and a faulted finger has no new cycles. A call costs little
    /// if `cycle` is one of the last cycles.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn records_after(&self, finger: i32, cycle: u64, records: &mut Vec<CycleRecord>) -> Result<(), HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.dispatcher.records_after(finger, cycle, records)
    }

    /// Writes the last two seconds into a file for `sun2xp replay` (docs/black-box.md). An existing file is replaced
    /// only if the writing succeeds.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, if it has no cycle yet, if the file cannot be written, or if the
    /// path leads to something other than a regular file.
    pub fn write_black_box(&self, finger: i32, path: &Path) -> Result<(), HandError> {
        save_recording(&self.recording(finger)?, path)
    }
}
