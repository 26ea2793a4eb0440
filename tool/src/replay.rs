//! `sun2xp replay`: recomputes the cycles of a black box or of a recording.

mod black_box;
mod recording;
mod report;
mod tally;

use crate::failure::ExitStatus;
use crate::failure::Failure;
use crate::print::{self, Screen};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use sun2xp::files::open_regular_file;
use sun2xp::model::ShownPath;

/// Runs the controller with the recorded inputs, and compares its commands and reports with the recorded ones, bit for
/// bit.
///
/// The file is a black box or a recording (MCAP) of any length. Cycles that are missing in a recording are reported,
/// and the replay continues with the next recorded state.
///
/// Exit status: 0 if everything is equal, 1 if something differs or the file cannot be replayed, 2 for wrong usage.
/// With --json, a file that cannot be replayed leaves standard output empty.
#[derive(clap::Args)]
pub struct Arguments {
    /// A file of `sun2xp record`, a file that sun2xp_write_black_box wrote, or one that was written at a fault because
    /// `hand.black_box` is set.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Print one JSON object with `pass` and the results of every finger, for other programs.
    #[arg(long)]
    json: bool,
}

/// The first bytes of an MCAP file.
const MCAP_MAGIC: [u8; 8] = *b"\x89MCAP0\r\n";

pub fn run(arguments: &Arguments) -> Result<ExitStatus, Failure> {
    let file = &arguments.file;
    let report = if is_mcap(file) { recording::replay(file)? } else { black_box::replay(file)? };
    match arguments.json {
        true => print::json(&report)?,
        false => write!(io::stdout(), "{}", report.text(&Screen::stdout()))?,
    }
    Ok(if report.pass { ExitStatus::SUCCESS } else { ExitStatus::FAILURE })
}

/// Whether a file begins as an MCAP file does. Returns false for a file that cannot be read: the reader of black boxes
/// then reports the error.
fn is_mcap(path: &Path) -> bool {
    let mut begin = [0; MCAP_MAGIC.len()];
    let opened = open_regular_file(path, u64::MAX);
    opened.and_then(|mut file| file.read_exact(&mut begin)).is_ok() && begin == MCAP_MAGIC
}

/// Returns a failure that names the file.
fn in_file(path: &Path, reason: impl std::fmt::Display) -> Failure {
    format!("{}: {reason}", ShownPath(path)).into()
}
