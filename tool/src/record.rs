//! `sun2xp record`: records what an open hand does.

mod counts;
mod display;
mod files;

use crate::failure::{ExitStatus, Failure, wrong_usage};
use crate::interrupt::Interrupt;
use crate::recording::{Entry, Item, Recording};
use counts::Counts;
use display::Display;
use files::{Files, Limits, Turn};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use sun2xp::model::{Counted, FingerNumber, ShownPath};
use sun2xp::realtime::now;
use sun2xp::telemetry::{Description, Ended, Message, Reader};

/// Longest time for which the recorder waits for messages before it checks for Ctrl-C and for the end of `--seconds`.
const WAIT: Duration = Duration::from_millis(100);

/// Records every cycle of an open hand, with its events and status, into MCAP files, until Ctrl-C or until the hand is
/// closed. docs/recordings.md describes the files. `sun2xp export`, `sun2xp plot` and `sun2xp replay` read them.
///
/// Exit status: 0 if every cycle is recorded, 1 if cycles are lost or the recording failed, 2 for wrong usage.
#[derive(clap::Args)]
pub struct Arguments {
    /// The hand, if several are open.
    #[arg(long, value_name = "NAME")]
    hand: Option<String>,
    /// The file. Further files get numbers. Without this option the name consists of the hand's name, date and time, or
    /// is that of the black box with the ending .mcap.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Record for this time, s.
    #[arg(long, value_name = "S", value_parser = crate::record::positive)]
    seconds: Option<f64>,
    /// Begin a new file when a file has this size, MB.
    #[arg(long, value_name = "MB", value_parser = crate::record::positive)]
    max_size: Option<f64>,
    /// Begin a new file when a file has this age, s.
    #[arg(long, value_name = "S", value_parser = crate::record::positive)]
    max_age: Option<f64>,
    /// Delete the oldest files of this recording, so that at most this number is left.
    #[arg(long, value_name = "FILES", value_parser = clap::value_parser!(u32).range(1..))]
    keep: Option<u32>,
    /// Convert this black box to a recording, instead of recording an open hand.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["hand", "seconds", "max_size", "max_age", "keep"])]
    from_black_box: Option<PathBuf>,
}

/// Parses a positive number of at most 1e9. A billion seconds are 31 years, and no disk holds a billion MB.
fn positive(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| "it is not a number".to_owned())?;
    if number > 0.0 && number <= 1e9 { Ok(number) } else { Err("it must be above 0, and at most 1e9".into()) }
}

pub fn run(arguments: &Arguments) -> Result<ExitStatus, Failure> {
    let limits = Limits {
        bytes: arguments.max_size.map(|megabytes| (megabytes * 1e6) as u64),
        age: arguments.max_age.map(Duration::try_from_secs_f64).transpose()?,
        keep: arguments.keep,
    };
    if limits.keep.is_some() && limits.bytes.is_none() && limits.age.is_none() {
        return Err(wrong_usage("--keep needs --max-size or --max-age: otherwise there is only one file"));
    }
    match &arguments.from_black_box {
        Some(black_box) => convert(black_box, arguments, limits),
        None => record(arguments, limits),
    }
}

fn record(arguments: &Arguments, limits: Limits) -> Result<ExitStatus, Failure> {
    let interrupt = Interrupt::watch()?;
    let mut reader = Reader::attach(arguments.hand.as_deref())?;
    let mut files = Files::begin(arguments.output.clone(), reader.description(), limits, now())?;
    let duration = arguments.seconds.map(Duration::try_from_secs_f64).transpose()?;
    let mut display = Display::new(files.path(), duration);
    let (began, mut counts, mut messages) = (Instant::now(), Counts::default(), Vec::new());
    let reason = loop {
        if interrupt.requested() {
            break None;
        }
        if duration.is_some_and(|duration| began.elapsed() >= duration) {
            break None;
        }
        messages.clear();
        let received = match reader.read(WAIT, &mut messages) {
            Ok(received) => received,
            Err(Ended::Closed) => break Some("the hand was closed"),
            Err(error) => {
                // What has arrived before is kept.
                files.finish()?;
                return Err(error.into());
            }
        };
        // A file begins only when there is something to write, so that the last one is not empty.
        let turn = if messages.is_empty() { Turn::default() } else { files.turn()? };
        if turn.begun {
            display.begin_file(files.path());
        }
        turn.undeleted.iter().for_each(|reason| display.line(reason));
        note_losses(received.lost, &mut files, &mut counts, &display)?;
        for message in &messages {
            counts.add(message);
            files.write(message)?;
        }
        files.flush()?;
        display.show(began.elapsed(), &counts, files.bytes());
    };
    drop(display);
    let path = files.finish()?;
    report(&path, began.elapsed(), &counts, reason)
}

fn note_losses(lost: [u64; 3], files: &mut Files, counts: &mut Counts, display: &Display) -> Result<(), Failure> {
    for (finger, lost) in FingerNumber::ALL.into_iter().zip(lost).filter(|(_, lost)| *lost > 0) {
        counts.lost += lost;
        files.write_lost(finger, lost)?;
        let lost = Counted(lost, "cycle is", "cycles are");
        display.line(&format!(
            "finger {finger}: {lost} lost, because this recorder or a thread of the hand was too slow. The topic /lost \
             marks the gap. Reduce the load of the machine, or record to a faster disk"
        ));
    }
    Ok(())
}

fn report(path: &files::Written, took: Duration, counts: &Counts, reason: Option<&str>) -> Result<ExitStatus, Failure> {
    let reason = reason.map(|reason| format!(" ({reason})")).unwrap_or_default();
    // The cycles have been recorded, even if nobody reads this line.
    let _ = writeln!(io::stdout(), "{path}: {:.1} s, {counts}{reason}", took.as_secs_f64());
    Ok(if counts.lost == 0 { ExitStatus::SUCCESS } else { ExitStatus::FAILURE })
}

/// Converts a black box.
fn convert(black_box: &Path, arguments: &Arguments, limits: Limits) -> Result<ExitStatus, Failure> {
    let recording = Recording::open(black_box)?;
    if !recording.is_black_box() {
        let reason = "is a recording already, and not a black box: use it as it is";
        return Err(wrong_usage(format!("{} {reason}", ShownPath(black_box))));
    }
    let description: Description = recording.description().clone();
    let output = arguments.output.clone().unwrap_or_else(|| black_box.with_extension("mcap"));
    let mut recording = recording.peekable();
    // The first entry has the time of the first cycle. A black box without cycles begins at 0.
    let begin = recording.peek().and_then(|entry| entry.as_ref().ok()).map_or(0, |entry| entry.time);
    let begin = begin.saturating_add_signed(description.clock_offset.saturating_neg());
    let files = Files::begin(Some(output.clone()), &description, limits, begin)?;
    copy(recording, files).inspect_err(|_| {
        // A part of a black box would look like the file of a recorder that was killed.
        let _ = fs::remove_file(&output);
    })
}

/// Writes the entries of a black box.
fn copy(entries: impl Iterator<Item = Result<Entry, Failure>>, mut files: Files) -> Result<ExitStatus, Failure> {
    let mut counts = Counts::default();
    let (mut first, mut last) = (None, 0);
    for entry in entries {
        let entry = entry?;
        // The other items mark lost cycles. A black box has no such items.
        let Item::Message(message) = &entry.item else { continue };
        if matches!(message, Message::Cycle { .. }) {
            first.get_or_insert(entry.time);
            last = entry.time;
        }
        counts.add(message);
        files.write(message)?;
    }
    let path = files.finish()?;
    report(&path, Duration::from_nanos(last.saturating_sub(first.unwrap_or(last))), &counts, None)
}
