//! `sun2xp replay`: recomputes the cycles of a black box file.

use crate::failure::Failure;
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;
use sun2xp::control::Activity;
use sun2xp::finger::{CycleRecord, Difference, Recording};
use sun2xp::model::{Shown, ShownPath};

/// Runs the controller with the inputs recorded in a black box file, and compares its commands with the recorded
/// commands, bit for bit.
///
/// Exit status: 0 if all are equal, 2 if something differs, 1 if the file cannot be replayed.
#[derive(clap::Args)]
pub struct Arguments {
    /// A file that WriteBlackBox wrote, or that was written at a fault because `hand.black_box` is set.
    #[arg(value_name = "FILE")]
    file: PathBuf,
}

/// Exit status if something differs.
const DIFFERENT: u8 = 2;

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let recording = Recording::open(&arguments.file)?;
    let replayed = recording.replay().map_err(|error| format!("{}: {error}", ShownPath(&arguments.file)))?;
    let mut output = io::stdout().lock();
    describe(&recording, &mut output)?;
    match &replayed.first {
        None => {
            writeln!(output, "replay       {} cycles, every motor command the same to the last bit", replayed.cycles)?;
            Ok(ExitCode::SUCCESS)
        }
        Some(first) => {
            writeln!(output, "replay       {} of {} cycles differ", replayed.different, replayed.cycles)?;
            show(first, &recording, &mut output)?;
            Ok(ExitCode::from(DIFFERENT))
        }
    }
}

fn describe(recording: &Recording, output: &mut impl Write) -> io::Result<()> {
    let (origin, cycles) = (&recording.origin, &recording.cycles);
    let rate = origin.hand.rate;
    writeln!(output, "finger       {}, at {rate} Hz, recorded by library {}", origin.finger, recording.library)?;
    let (Some(first), Some(last)) = (cycles.first(), cycles.last()) else {
        return writeln!(output, "cycles       none");
    };
    let seconds = last.began.saturating_sub(first.began) as f64 * 1e-9;
    writeln!(output, "cycles       {}, {} to {}, {seconds:.3} s", cycles.len(), first.cycle, last.cycle)?;
    let mut stages = BTreeMap::new();
    for cycle in cycles {
        *stages.entry(cycle.stage.as_str()).or_insert(0u32) += 1;
    }
    for (stage, count) in stages {
        writeln!(output, "stage        {count} {}", Shown(stage))?;
    }
    let lost = |cycle: &&CycleRecord<String>| cycle.feedback.is_none();
    let longest = cycles.split(|cycle| cycle.feedback.is_some()).map(<[_]>::len).max().unwrap_or(0);
    writeln!(output, "lost         {} replies, at most {longest} in a row", cycles.iter().filter(lost).count())?;
    let controls = || cycles.iter().filter_map(|cycle| cycle.control.as_ref());
    let skipped: u64 = controls().map(|control| control.input.skipped).sum();
    let adjusted = controls().filter(|control| control.previous != control.controller).count();
    let restarts = controls().filter(|control| control.input.anew_from.is_some()).count();
    let mut set_points: Vec<_> = controls()
        .filter_map(|control| match control.input.activity {
            Activity::Follow(set_point) => Some(set_point),
            _ => None,
        })
        .collect();
    set_points.dedup();
    writeln!(
        output,
        "events       {} set points, {adjusted} adjustments, {restarts} restarts, {skipped} periods skipped",
        set_points.len()
    )?;
    let strongest = controls().map(|control| control.command.motor_torques.amax()).fold(0.0, f64::max);
    writeln!(output, "motors       at most {strongest:.3} N cm")
}

fn show(first: &Difference, recording: &Recording, output: &mut impl Write) -> io::Result<()> {
    // The first line of the file is the header, so the cycle with index 0 is in line 2.
    writeln!(output, "first        cycle {}, line {}", recording.cycles[first.index].cycle, first.index + 2)?;
    let (recorded, replayed) = (&first.recorded, &first.replayed);
    let (was, is) = (recorded.command.motor_torques, replayed.command.motor_torques);
    for motor in (0..4).filter(|&motor| was[motor].to_bits() != is[motor].to_bits()) {
        writeln!(output, "motor {}      recorded {:e}, replayed {:e} N cm", motor + 1, was[motor], is[motor])?;
    }
    if recorded.report != replayed.report {
        writeln!(output, "recorded     {:?}", recorded.report)?;
        writeln!(output, "replayed     {:?}", replayed.report)?;
    }
    Ok(())
}
