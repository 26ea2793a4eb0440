//! Replay of a black box file.

use super::in_file;
use super::report::{FingerReport, FirstDifference, Report};
use crate::failure::Failure;
use crate::print::Progress;
use crate::recording::or_by;
use std::path::Path;
use sun2xp::finger::{Difference, Recording};

const NOTHING_TO_REPLAY: &str = "it contains no cycles in which a controller has run, so none can be replayed: name \
                                 the black box of a finger that has run";

/// Replays a black box file.
pub fn replay(file: &Path) -> Result<Report, Failure> {
    let recording = Recording::open(file)?;
    let progress = Progress::new("replay", recording.cycles.len() as u64);
    let replayed = recording.replay_with(|index| progress.reach(index as u64));
    drop(progress);
    let replayed = replayed.map_err(|error| in_file(file, format_args!("{error}{}", or_by(&recording.library))))?;
    if replayed.cycles == 0 {
        return Err(in_file(file, NOTHING_TO_REPLAY));
    }
    let mut finger = FingerReport::new(recording.origin.finger, recording.origin.hand.rate);
    recording.cycles.iter().for_each(|cycle| finger.contents.add(cycle));
    (finger.replayed, finger.different) = (replayed.cycles as u64, replayed.different as u64);
    finger.states = 1;
    finger.first_difference = replayed.first.map(|Difference { index, recorded, replayed }| {
        let cycle = recording.cycles[index].cycle;
        // The first line of the file is the header, so the cycle with index 0 is in line 2.
        FirstDifference::in_cycle(cycle, &recorded, &replayed).in_line(index + 2)
    });
    Ok(Report::new(recording.library, false, vec![finger]))
}
