//! Writing black boxes into files: at a fault, if configured, and on request.

use crate::files::create_file;
use crate::finger::Recording;
use crate::hand::HandError;
use crate::hand::notice::print_notice;
use crate::model::ShownPath;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

/// Largest number of files for one finger in one second.
const MOST_FILES: u32 = 100;

/// Writes a recording that was taken from an open hand. This function needs no hand, because the hand may be closed
/// before the file is written.
///
/// # Errors
/// Returns an error if the file cannot be written.
pub fn save_recording(recording: &Recording, path: &Path) -> Result<(), HandError> {
    recording.save(path).map_err(|source| HandError::BlackBox { path: path.to_path_buf(), source })
}

/// Writes the recording of a fault into a new file in `folder`, and reports the file or the failure as a warning.
pub(super) fn save_at_fault(recording: &Recording, folder: &Path) {
    let finger = recording.origin.finger;
    print_notice(&match write_new(recording, folder) {
        Ok(path) => {
            format!(
                "finger {finger} faulted: its last two seconds are in {} (sun2xp replay reads them)",
                ShownPath(&path)
            )
        }
        Err(error) => {
            format!(
                "finger {finger} faulted, but its black box cannot be written to {}: {error}. Set hand.black_box to a \
                 folder that exists, has free space and is writable for this user",
                ShownPath(folder)
            )
        }
    });
}

fn write_new(recording: &Recording, folder: &Path) -> io::Result<PathBuf> {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let names = (1..=MOST_FILES).map(|count| format!("finger-{}-{seconds}-{count}.jsonl", recording.origin.finger));
    create_file(folder, names, |output| recording.write(output))
}
