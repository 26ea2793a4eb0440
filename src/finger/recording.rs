//! A black box as a file: lines of JSON, the first of which says what all others need. docs/black-box.md describes it.

use crate::control::State;
use crate::files::{open_regular_file, replace_file};
use crate::finger::{ControllerSource, CycleRecord};
use crate::model::configuration::ConfiguredHand;
use serde::{Deserialize, Serialize};
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};
use thiserror::Error;

/// Version of the format.
const VERSION: u32 = 1;

/// The largest recording that is read, bytes. Two seconds at the highest rate take 13 MB.
const LARGEST: u64 = 1 << 28;

/// A stretch of a finger's life, without a gap, and everything that is needed to compute it again.
#[derive(Clone, Debug)]
pub struct Recording {
    /// What the cycles start from.
    pub origin: Origin,
    /// Version of the library that recorded it.
    pub library: String,
    /// One after the other.
    pub cycles: Vec<CycleRecord<String>>,
}

/// What the cycles of a recording start from.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Origin {
    /// 1 to 3.
    pub finger: i32,
    /// With the rate.
    pub hand: ConfiguredHand,
    /// Every controller that the cycles name.
    pub controllers: Vec<ControllerSource>,
    /// Of the first cycle's controller, before that cycle.
    pub state: State,
}

/// The first line of a file.
#[derive(Deserialize, Serialize)]
struct Header {
    #[serde(flatten)]
    identity: Identity,
    /// Lines that follow.
    cycles: usize,
    /// When it was written, s since 1970.
    written: u64,
    origin: Origin,
}

/// What every version of the format begins with.
#[derive(Deserialize, Serialize)]
struct Identity {
    sun2xp_black_box: u32,
    library: String,
}

/// Why a file is no recording that can be replayed.
#[derive(Debug, Error)]
pub enum RecordingError {
    /// The system cannot read it.
    #[error("cannot read {0}: {1}")]
    Unreadable(String, io::Error),
    /// It is something else.
    #[error("{0} is no black box of sun2xp: {1}")]
    Foreign(String, serde_json::Error),
    /// Another version of the format.
    #[error(
        "{file} has version {found} of the format, this program reads {VERSION}: replay it with library {library}, which wrote it"
    )]
    Version {
        /// The file.
        file: String,
        /// Its version.
        found: u32,
        /// What wrote it.
        library: String,
    },
    /// A line that does not fit.
    #[error("{file}, line {line}: {reason}. It was written by library {library}, this is {}: their state may differ", env!("CARGO_PKG_VERSION"))]
    Line {
        /// The file.
        file: String,
        /// Counted from 1.
        line: usize,
        /// What is wrong with it.
        reason: String,
        /// What wrote it.
        library: String,
    },
    /// Cycles are missing.
    #[error("{file} ends after {found} of {expected} cycles: it was cut off, copy it again")]
    Short {
        /// The file.
        file: String,
        /// Cycles that are there.
        found: usize,
        /// Cycles that the first line tells of.
        expected: usize,
    },
}

impl Recording {
    pub(super) fn new(origin: Origin, cycles: Vec<CycleRecord<String>>) -> Self {
        Self { origin, library: env!("CARGO_PKG_VERSION").into(), cycles }
    }

    /// Writes it into a new file, or in the place of an old one, which stays as it was until the new one is whole.
    ///
    /// # Errors
    /// What the system says; a path that leads to something other than a regular file, such as a symbolic link.
    pub fn save(&self, path: &Path) -> io::Result<()> {
        replace_file(path, |output| self.write(output))
    }

    /// Writes it.
    ///
    /// # Errors
    /// What the system says.
    pub fn write(&self, output: impl Write) -> io::Result<()> {
        let mut output = BufWriter::new(output);
        let header = Header {
            identity: Identity { sun2xp_black_box: VERSION, library: self.library.clone() },
            cycles: self.cycles.len(),
            written: SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()),
            origin: self.origin.clone(),
        };
        serde_json::to_writer(&mut output, &header)?;
        output.write_all(b"\n")?;
        for cycle in &self.cycles {
            serde_json::to_writer(&mut output, cycle)?;
            output.write_all(b"\n")?;
        }
        output.flush()
    }

    /// Reads a file.
    ///
    /// # Errors
    /// A file that cannot be read, or is no whole recording of this version.
    pub fn open(path: &Path) -> Result<Self, RecordingError> {
        let file = path.display().to_string();
        let unreadable = |error| RecordingError::Unreadable(file.clone(), error);
        let mut lines = BufReader::new(open_regular_file(path, LARGEST).map_err(unreadable)?).lines();
        let first = lines.next().transpose().map_err(unreadable)?.unwrap_or_default();
        let Identity { sun2xp_black_box: found, library } =
            serde_json::from_str(&first).map_err(|error| RecordingError::Foreign(file.clone(), error))?;
        if found != VERSION {
            return Err(RecordingError::Version { file, found, library });
        }
        let wrong = |line: usize, reason: String| RecordingError::Line {
            file: file.clone(),
            line,
            reason,
            library: library.clone(),
        };
        let header: Header = serde_json::from_str(&first).map_err(|error| wrong(1, error.to_string()))?;
        let mut cycles: Vec<CycleRecord<String>> = Vec::new();
        for (index, line) in lines.enumerate() {
            let wrong = |reason| wrong(index + 2, reason);
            let cycle: CycleRecord<String> =
                serde_json::from_str(&line.map_err(unreadable)?).map_err(|error| wrong(error.to_string()))?;
            if cycles.last().is_some_and(|last| last.cycle + 1 != cycle.cycle) {
                return Err(wrong("its cycle does not follow the one before".into()));
            }
            cycles.push(cycle);
        }
        if cycles.len() != header.cycles {
            return Err(RecordingError::Short { file, found: cycles.len(), expected: header.cycles });
        }
        Ok(Self { origin: header.origin, library, cycles })
    }
}
