//! `sun2xp replay`: recomputes the cycles of a black box and compares them with the record.

mod report;

use crate::failure::Failure;
use crate::print::{self, Screen};
use report::Report;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use sun2xp::finger::Recording;
use sun2xp::model::ShownPath;

/// Runs the controller with the inputs recorded in a black box file, and compares its commands with the recorded
/// commands, bit for bit.
///
/// Exit status: 0 if all are equal, 1 if something differs or the file cannot be replayed, 2 for wrong usage. With
/// --json, a file that cannot be replayed leaves standard output empty.
#[derive(clap::Args)]
pub struct Arguments {
    /// A file that WriteBlackBox wrote, or that was written at a fault because `hand.black_box` is set.
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Print one JSON object with `pass` and the contents of the file, for other programs.
    #[arg(long)]
    json: bool,
}

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let recording = Recording::open(&arguments.file)?;
    let replayed = recording.replay().map_err(|error| format!("{}: {error}", ShownPath(&arguments.file)))?;
    let report = Report::new(&recording, &replayed);
    match arguments.json {
        true => print::json(&report)?,
        false => write!(io::stdout(), "{}", report.text(&Screen::stdout()))?,
    }
    Ok(if report.pass { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
