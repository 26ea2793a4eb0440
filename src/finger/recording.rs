//! A black box as a file that consists of lines of JSON. The first line contains the data that all other lines need.
//! docs/black-box.md describes the format.

mod reading;

use crate::control::State;
use crate::files::replace_file;
use crate::finger::{ControllerSource, CycleRecord};
use crate::model::configuration::ConfiguredHand;
use crate::model::snapshot;
use crate::realtime::clock_offset;
use serde::{Deserialize, Serialize};
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};
use thiserror::Error;

/// Version of the format.
const VERSION: u32 = 1;

/// The last sentence of an error about a file with content that the library never writes. It gives the cause and the
/// remedy.
pub const ALTERED: &str = "The file was altered or damaged after it was written: copy it again";

/// Consecutive cycles of a finger, and everything that is needed to compute them again.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Recording {
    /// The data that all cycles start from.
    pub origin: Origin,
    /// Version of the library that made the recording.
    pub library: String,
    /// Time since 1970 minus the time of the monotonic clock, ns. Added to the time of a cycle, it gives the time
    /// since 1970.
    pub clock_offset: i64,
    /// The cycles, without a gap.
    pub cycles: Vec<CycleRecord<String>>,
}

/// The data that the cycles of a recording start from.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Origin {
    /// Number of the finger, 1 to 3.
    pub finger: i32,
    /// The hand's configuration, with the rate.
    #[serde(serialize_with = "snapshot::serialize")]
    pub hand: ConfiguredHand,
    /// Every controller that the cycles name.
    #[serde(deserialize_with = "reading::controllers")]
    pub controllers: Vec<ControllerSource>,
    /// State of the first cycle's controller before that cycle.
    #[serde(serialize_with = "snapshot::serialize")]
    pub state: State,
}

/// The first line of a file.
#[derive(Deserialize, Serialize)]
struct Header {
    sun2xp_black_box: u32,
    library: String,
    /// Number of lines that follow.
    cycles: usize,
    /// Time of writing, s since 1970.
    written: u64,
    /// See [`Recording::clock_offset`]. A file of an older library does not have it.
    #[serde(default)]
    clock_offset: Option<i64>,
    origin: Origin,
}

/// The reason why a file is not a recording that can be replayed.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// The file cannot be read, it is not a regular file of an acceptable size, or a line is too long.
    #[error("cannot read {0}: {1}. Name a readable file that a hand has written as its black box")]
    Unreadable(String, io::Error),
    /// The file is not a black box.
    #[error("{0} is not a black box of sun2xp: {1}. Use a file that a hand has written as its black box")]
    Foreign(String, String),
    /// The file has another version of the format.
    #[error(
        "{file} has format version {found}, and this program reads version {VERSION}: replay it with library \
         {library}, which wrote it"
    )]
    Version {
        /// The file.
        file: String,
        /// Version of the file.
        found: u32,
        /// Version of the library that wrote the file.
        library: String,
    },
    /// A line cannot be parsed, or its cycle number does not follow that of the previous line.
    #[error("{file}, line {line}: {reason}{}", written_by(library))]
    Line {
        /// The file.
        file: String,
        /// Number of the line, from 1.
        line: usize,
        /// What is wrong with the line.
        reason: String,
        /// Version of the library that wrote the file.
        library: String,
    },
    /// Cycles are missing.
    #[error("{file} ends after {found} of {expected} cycles: the file is truncated, copy it again")]
    Short {
        /// The file.
        file: String,
        /// Number of cycles in the file.
        found: usize,
        /// Number of cycles that the first line announces.
        expected: usize,
    },
    /// The file has more cycles than its first line announces, or than a black box can have.
    #[error("{file} has more than {most} cycles. {ALTERED}")]
    Long {
        /// The file.
        file: String,
        /// Largest number of cycles that it may have.
        most: usize,
    },
}

/// Returns the cause and the remedy of a wrong line. Different versions of the library record different data.
fn written_by(library: &str) -> String {
    match env!("CARGO_PKG_VERSION") {
        own if own == library => format!(". {ALTERED}"),
        own => format!(". Library {library} wrote it, and this is library {own}: replay it with library {library}"),
    }
}

impl Recording {
    pub(super) fn new(origin: Origin, cycles: Vec<CycleRecord<String>>) -> Self {
        Self { origin, library: env!("CARGO_PKG_VERSION").into(), clock_offset: clock_offset(), cycles }
    }

    /// Writes the recording to a file. An existing file stays unchanged until the new one is complete.
    ///
    /// # Errors
    /// Returns the error that the system reports. Also returns an error if `path` is a symbolic link, a folder or
    /// anything else that is not a regular file.
    pub fn save(&self, path: &Path) -> io::Result<()> {
        replace_file(path, |output| self.write(output))
    }

    /// Writes the recording.
    ///
    /// # Errors
    /// Returns the error that the system reports.
    pub fn write(&self, output: impl Write) -> io::Result<()> {
        // A trait object, so that the code is compiled once for all kinds of outputs.
        let output: &mut dyn Write = &mut { output };
        let mut output = BufWriter::new(output);
        let header = Header {
            sun2xp_black_box: VERSION,
            library: self.library.clone(),
            cycles: self.cycles.len(),
            written: SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()),
            clock_offset: Some(self.clock_offset),
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
}
