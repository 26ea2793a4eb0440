//! Snapshots: the state as JSON, and the screen as text and as a picture.

use super::picture::svg;
use super::state::HandState;
use super::words::utc;
use ratatui::buffer::Buffer;
use std::fs::OpenOptions;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

/// Largest number of snapshots in one second.
const MOST: u32 = 100;

/// Writes the state to `sun2xp-NAME-TIME.json`, and the screen to the same name with `.txt` and `.svg`, in `folder`.
/// Returns the paths. Existing files are not replaced.
///
/// # Errors
/// Returns an error if a file cannot be written.
pub fn write(folder: &Path, hand: &HandState, screen: &Buffer) -> io::Result<[PathBuf; 3]> {
    let seconds = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs());
    let time = utc(seconds).replace([':', '-'], "");
    let contents = [serde_json::to_vec_pretty(hand)?, text(screen).into_bytes(), svg(screen).into_bytes()];
    write_new(folder, &format!("sun2xp-{}-{time}", hand.name), &contents)
}

/// Writes the files under this name. If the name is taken, appends the first free number to it.
fn write_new(folder: &Path, name: &str, contents: &[Vec<u8>; 3]) -> io::Result<[PathBuf; 3]> {
    for number in 0..MOST {
        let suffix = if number == 0 { String::new() } else { format!("-{number}") };
        let paths = ["json", "txt", "svg"].map(|extension| folder.join(format!("{name}{suffix}.{extension}")));
        let taken = |path: &PathBuf| path.symlink_metadata().is_ok();
        if paths.iter().any(taken) {
            continue;
        }
        for (path, content) in paths.iter().zip(contents) {
            OpenOptions::new().write(true).create_new(true).open(path)?.write_all(content)?;
        }
        return Ok(paths);
    }
    Err(io::Error::other(format!("there are already {MOST} snapshots of this second: try again in a second")))
}

/// Describes why a snapshot was not written into this folder, and what to do.
pub fn refusal(folder: &str, error: &io::Error) -> String {
    // Another folder helps only if the system has refused this one.
    let remedy = match error.raw_os_error() {
        Some(_) => ". Start the command again with --snapshots and a writable folder",
        None => "",
    };
    format!("cannot write a snapshot into {folder}: {error}{remedy}")
}

/// Returns the characters of a screen: a line of text for each row, without spaces at the ends of the lines.
pub fn text(buffer: &Buffer) -> String {
    let width = usize::from(buffer.area.width).max(1);
    let mut text = String::new();
    for line in buffer.content.chunks(width) {
        let line: String = line.iter().map(|cell| cell.symbol()).collect();
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_folder_is_the_remedy_only_if_the_system_has_refused_this_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let contents = [Vec::new(), Vec::new(), Vec::new()];
        for _ in 0..MOST {
            write_new(folder.path(), "same-second", &contents).expect("written");
        }
        let many = write_new(folder.path(), "same-second", &contents).expect_err("too many");
        let text = "cannot write a snapshot into F: there are already 100 snapshots of this second: try again in a \
                    second";
        assert_eq!(refusal("F", &many), text);
        let missing = write_new(&folder.path().join("none"), "name", &contents).expect_err("no such folder");
        let text = refusal("F", &missing);
        assert!(text.ends_with(". Start the command again with --snapshots and a writable folder"), "{text}");
    }
}
