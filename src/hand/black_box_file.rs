//! Black boxes in files: written at a fault where that is configured, and when asked.

use crate::files::create_file;
use crate::finger::Recording;
use crate::hand::HandError;
use crate::hand::notice::print_notice;
use crate::model::ShownPath;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

/// Files of one finger in one second.
const MOST: u32 = 100;

/// Writes a recording that was taken while there was a hand: writing may take longer than the hand is open.
///
/// # Errors
/// A file that cannot be written.
pub fn save_recording(recording: &Recording, path: &Path) -> Result<(), HandError> {
    recording.save(path).map_err(|source| HandError::BlackBox { path: path.to_path_buf(), source })
}

/// Writes the recording of a fault into `folder`, as a new file, and says so; or why not.
pub(super) fn keep(recording: &Recording, folder: &Path) {
    let finger = recording.origin.finger;
    print_notice(&match write_new(recording, folder) {
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
