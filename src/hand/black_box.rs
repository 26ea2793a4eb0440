//! The black boxes of an open hand: kept at all times, written to a file at a fault where that is configured, and when asked.

use crate::files::create_file;
use crate::finger::{KeptRecord, Recording};
use crate::hand::announcement::say;
use crate::hand::{Hand, HandError};
use crate::model::ShownPath;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

/// Files of one finger in one second.
const MOST: u32 = 100;

impl Hand {
    /// The last two seconds of finger 1, 2 or 3; of a faulted one the last two before the fault.
    ///
    /// # Errors
    /// No such finger.
    pub fn recording(&self, finger: i32) -> Result<Recording, HandError> {
        self.dispatcher.recording(finger)?.ok_or(HandError::NoAnswer(finger))
    }

    /// One cycle of the last two seconds of finger 1, 2 or 3, or the newest.
    ///
    /// # Errors
    /// No such finger, a cycle that is not kept.
    pub fn record(&self, finger: i32, cycle: Option<u64>) -> Result<KeptRecord, HandError> {
        self.dispatcher.record(finger, cycle)?.ok_or(HandError::NoRecord { finger, cycle: cycle.unwrap_or_default() })
    }

    /// Writes them into a file, new or in the place of an old one: `sun2xp replay` and docs/black-box.md tell what to
    /// do with it. If that fails, an old file stays as it was.
    ///
    /// # Errors
    /// No such finger, a file that cannot be written, a path that leads to something other than a regular file.
    pub fn write_black_box(&self, finger: i32, path: &Path) -> Result<(), HandError> {
        save(&self.recording(finger)?, path)
    }
}

/// Writes a recording that was taken while there was a hand: writing may take longer than the hand is open.
///
/// # Errors
/// A file that cannot be written.
pub fn save(recording: &Recording, path: &Path) -> Result<(), HandError> {
    recording.save(path).map_err(|source| HandError::BlackBox { path: path.to_path_buf(), source })
}

/// Writes the recording of a fault into `folder`, as a new file, and says so; or why not.
pub(super) fn keep(recording: &Recording, folder: &Path) {
    let finger = recording.origin.finger;
    say(&match write_new(recording, folder) {
        Ok(path) => {
            format!("finger {finger} faulted: its last two seconds are in {} (see sun2xp replay)", ShownPath(&path))
        }
        Err(error) => {
            format!("finger {finger} faulted, and its black box cannot be written into {}: {error}", ShownPath(folder))
        }
    });
}

fn write_new(recording: &Recording, folder: &Path) -> io::Result<PathBuf> {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let names = (1..=MOST).map(|count| format!("finger-{}-{seconds}-{count}.jsonl", recording.origin.finger));
    create_file(folder, names, |output| recording.write(output))
}
