//! Reading a black box file. The file may have been altered, so all sizes are limited. No file can make this program
//! use much memory.

use super::{Header, Recording, RecordingError, VERSION};
use crate::files::open_regular_file;
use crate::finger::{ControllerSource, CycleRecord};
use crate::model::{Shown, ShownPath, one_line};
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;
use std::io::{self, BufRead, BufReader, ErrorKind, Read};
use std::path::Path;

/// Largest file, bytes. Two seconds at the highest rate take 13 MB, and a thousand controllers take 3 MB.
const LARGEST: u64 = 1 << 26;

/// Longest line of a cycle, bytes. The library writes about 1300.
const LONGEST_LINE: u64 = 1 << 16;

/// Largest number of cycles. It is five times the number of cycles in two seconds at the highest rate.
const MOST_CYCLES: usize = 50_000;

/// Largest number of controllers. A planner needs more than half a millisecond to change the controller, so fewer
/// changes fit into the two seconds of a recording.
const MOST_CONTROLLERS: usize = 4096;

/// Longest reason that is shown, characters.
const LONGEST_REASON: usize = 200;

/// The fields that the header has in every version of the format.
#[derive(Deserialize)]
struct Identity {
    sun2xp_black_box: u32,
    library: String,
}

impl Recording {
    /// Reads a file.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read, or is not a complete recording of this version.
    pub fn open(path: &Path) -> Result<Self, RecordingError> {
        let file = ShownPath(path).to_string();
        match open_regular_file(path, LARGEST) {
            Ok(input) => Self::read(BufReader::new(input), &file),
            Err(error) => Err(RecordingError::Unreadable(file, error)),
        }
    }

    /// Reads a recording from `input`. Error texts use the name `file` for it.
    ///
    /// # Errors
    /// Returns an error if `input` cannot be read, or is not a complete recording of this version.
    pub fn read(mut input: impl BufRead, file: &str) -> Result<Self, RecordingError> {
        let file = file.to_string();
        let unreadable = |error| RecordingError::Unreadable(file.clone(), error);
        let first = next_line(&mut input, LARGEST).map_err(unreadable)?.unwrap_or_default();
        let foreign = |reason: String| RecordingError::Foreign(file.clone(), reason);
        let Identity { sun2xp_black_box: found, library } =
            serde_json::from_slice(&first).map_err(|error| foreign(describe(&error)))?;
        let library = Shown(&library).to_string();
        if found != VERSION {
            return Err(RecordingError::Version { file, found, library });
        }
        let wrong = |line: usize, reason: String| RecordingError::Line {
            file: file.clone(),
            line,
            reason,
            library: library.clone(),
        };
        let header: Header = serde_json::from_slice(&first).map_err(|error| wrong(1, describe(&error)))?;
        if header.cycles > MOST_CYCLES {
            return Err(RecordingError::Long { file, most: MOST_CYCLES });
        }
        let mut cycles: Vec<CycleRecord<String>> = Vec::new();
        while let Some(line) = next_line(&mut input, LONGEST_LINE).map_err(unreadable)? {
            let wrong = |reason| wrong(cycles.len() + 2, reason);
            if cycles.len() == header.cycles {
                return Err(RecordingError::Long { file, most: header.cycles });
            }
            let cycle: CycleRecord<String> = serde_json::from_slice(&line).map_err(|error| wrong(describe(&error)))?;
            if cycles.last().is_some_and(|last| last.cycle.checked_add(1) != Some(cycle.cycle)) {
                return Err(wrong("its cycle number does not follow that of the previous line".into()));
            }
            cycles.push(cycle);
        }
        if cycles.len() != header.cycles {
            return Err(RecordingError::Short { file, found: cycles.len(), expected: header.cycles });
        }
        // If the file has no clock offset, the last cycle counts as having begun when the file was written.
        let last = cycles.last().map_or(0, |cycle| cycle.began);
        let written = header.written.saturating_mul(1_000_000_000) as i64;
        let clock_offset = header.clock_offset.unwrap_or(written.wrapping_sub(last as i64));
        Ok(Self { origin: header.origin, library, clock_offset, cycles })
    }
}

/// Reads a line of at most `longest` bytes, without its end; none after the last line.
fn next_line(input: &mut impl BufRead, longest: u64) -> io::Result<Option<Vec<u8>>> {
    let mut line = Vec::new();
    if input.take(longest + 1).read_until(b'\n', &mut line)? == 0 {
        return Ok(None);
    }
    if line.last() == Some(&b'\n') {
        line.pop();
    }
    if line.len() as u64 > longest {
        return Err(io::Error::new(ErrorKind::InvalidData, format!("it has a line of more than {longest} bytes")));
    }
    Ok(Some(line))
}

/// Returns what is wrong with a line. The parser sees only a single line. The line number in its error is therefore
/// always 1 and is removed, but the column is kept.
fn describe(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let reason = text.rsplit_once(" at line ").map_or(text.as_str(), |(reason, _)| reason);
    // The reason may contain any text of the file.
    let shown = one_line(&reason.chars().take(LONGEST_REASON).collect::<String>());
    format!("{shown} (column {})", error.column())
}

/// Reads the controllers, with a limit on their number.
pub(super) fn controllers<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<ControllerSource>, D::Error> {
    struct Bounded;

    impl<'de> Visitor<'de> for Bounded {
        type Value = Vec<ControllerSource>;

        fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
            write!(formatter, "at most {MOST_CONTROLLERS} controllers")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<Self::Value, A::Error> {
            let mut controllers = Vec::new();
            while let Some(controller) = elements.next_element()? {
                if controllers.len() == MOST_CONTROLLERS {
                    return Err(A::Error::custom(format!("more than {MOST_CONTROLLERS} controllers")));
                }
                controllers.push(controller);
            }
            Ok(controllers)
        }
    }

    deserializer.deserialize_seq(Bounded)
}
