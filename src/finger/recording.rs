//! A black box as a file: lines of JSON, the first of which says what all others need. docs/black-box.md describes it.

mod reading;

use crate::control::State;
use crate::files::replace_file;
use crate::finger::{ControllerSource, CycleRecord};
use crate::model::configuration::ConfiguredHand;
use serde::{Deserialize, Serialize};
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};
use thiserror::Error;

/// Version of the format.
const VERSION: u32 = 1;

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
    #[serde(deserialize_with = "reading::controllers")]
    pub controllers: Vec<ControllerSource>,
    /// Of the first cycle's controller, before that cycle.
    pub state: State,
}

/// The first line of a file.
#[derive(Deserialize, Serialize)]
struct Header {
    sun2xp_black_box: u32,
    library: String,
    /// Lines that follow.
    cycles: usize,
    /// When it was written, s since 1970.
    written: u64,
    origin: Origin,
}

/// Why a file is no recording that can be replayed.
#[derive(Debug, Error)]
pub enum RecordingError {
    /// The system cannot read it, or it is not a regular file of a sensible size.
    #[error("cannot read {0}: {1}")]
    Unreadable(String, io::Error),
    /// It is something else.
    #[error("{0} is not a black box of sun2xp: {1}")]
    Foreign(String, String),
    /// Another version of the format.
    #[error(
        "{file} has version {found} of the format, this program reads {VERSION}: replay it with library {library}, \
         which wrote it"
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
    #[error("{file}, line {line}: {reason}{}", written_by(library))]
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
    /// The file has more cycles than its first line announces, or than a black box can have.
    #[error("{file} has more than {most} cycles: it is not a black box as it was written")]
    Long {
        /// The file.
        file: String,
        /// How many it may have.
        most: usize,
    },
}

/// Libraries of different versions remember different things.
fn written_by(library: &str) -> String {
    match env!("CARGO_PKG_VERSION") {
        own if own == library => String::new(),
        own => format!(". Library {library} wrote it and this is {own}: replay it with that one"),
    }
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
            sun2xp_black_box: VERSION,
            library: self.library.clone(),
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
}
