//! Replay of a recording (MCAP), which may be larger than the memory.

use super::in_file;
use super::report::{FingerReport, FirstDifference, Report};
use crate::failure::Failure;
use crate::print::Progress;
use crate::recording::{Item, Recording, or_by};
use std::collections::BTreeMap;
use std::path::Path;
use sun2xp::finger::{ContinuousReplay, Step, Unsound};
use sun2xp::model::FingerNumber;
use sun2xp::telemetry::Message;

/// Number of steps of the progress.
const STEPS: u64 = 10_000;

/// A finger during the replay.
struct Replaying {
    replay: ContinuousReplay,
    report: FingerReport,
}

impl Replaying {
    fn new(finger: FingerNumber) -> Self {
        Self { replay: ContinuousReplay::default(), report: FingerReport::new(finger.get(), 0.0) }
    }

    fn take(&mut self, message: Message) -> Result<(), Unsound> {
        let Self { replay, report } = self;
        match message {
            Message::Controller { source, hand, .. } => {
                report.rate = hand.rate;
                replay.controller(*source, *hand)
            }
            Message::Keyframe { cycle, state, .. } => {
                report.states += 1;
                if !replay.keyframe(cycle, *state)? {
                    report.different_states += 1;
                    report.first_difference.get_or_insert_with(|| FirstDifference::in_state(cycle));
                }
                Ok(())
            }
            Message::Cycle { record, .. } => {
                let recomputed = replay.cycle(&record)?;
                report.contents.add(&record);
                if let Some(gap) = recomputed.gap {
                    report.add_gap(gap);
                }
                match (recomputed.step, &record.control) {
                    (Step::Waiting, _) => report.without_state += 1,
                    (Step::UnknownController(number), _) => report.add_without_controller(record.cycle, number),
                    (Step::Same, _) => report.replayed += 1,
                    (Step::Different(replayed), Some(recorded)) => {
                        report.replayed += 1;
                        report.different += 1;
                        let first = || FirstDifference::in_cycle(record.cycle, recorded, &replayed);
                        report.first_difference.get_or_insert_with(first);
                    }
                    (Step::Different(_), None) | (Step::Idle, _) => {}
                }
                Ok(())
            }
            _ => Ok(()),
        }
    }
}

/// Replays a recording.
pub fn replay(file: &Path) -> Result<Report, Failure> {
    let mut recording = Recording::open(file)?;
    let progress = Progress::new("replay", STEPS);
    let mut fingers: BTreeMap<FingerNumber, Replaying> = BTreeMap::new();
    let mut newest = None;
    while let Some(entry) = recording.next() {
        let Item::Message(message) = entry.map_err(|error| after(newest, &error))?.item else { continue };
        let Some(finger) = finger_of(&message) else { continue };
        newest = match &message {
            Message::Cycle { record, .. } => Some((finger, record.cycle)),
            _ => newest,
        };
        let replaying = fingers.entry(finger).or_insert_with(|| Replaying::new(finger));
        replaying.take(message).map_err(|error| {
            let other_remedy = or_by(&recording.description().library);
            in_file(file, format_args!("finger {finger}: {error}{other_remedy}"))
        })?;
        progress.reach((recording.progress() * STEPS as f64) as u64);
    }
    drop(progress);
    let reports: Vec<FingerReport> = fingers.into_values().map(|finger| finger.report).collect();
    if reports.iter().all(|report| report.replayed == 0) {
        let reason = if reports.iter().any(|report| report.without_controller > 0) {
            "it does not describe the controllers of its cycles, so none can be replayed: the descriptions were lost \
             during the recording, or the file was altered. Record again, or copy the file again"
        } else if reports.iter().any(|report| report.without_state > 0) {
            "it has no recorded state before any of its cycles, so none can be replayed: record for at least a second"
        } else {
            "it contains no cycles in which a controller has run: record while a finger is running"
        };
        return Err(in_file(file, reason));
    }
    Ok(Report::new(recording.description().library.clone(), !recording.is_complete(), reports))
}

/// Adds the last cycle that was read to the reason why a file cannot be read further.
fn after(newest: Option<(FingerNumber, u64)>, error: &Failure) -> String {
    match newest {
        None => error.to_string(),
        Some((finger, cycle)) => format!("{error}. The last cycle that was read is cycle {cycle} of finger {finger}"),
    }
}

fn finger_of(message: &Message) -> Option<FingerNumber> {
    match message {
        Message::Controller { finger, .. } | Message::Keyframe { finger, .. } | Message::Cycle { finger, .. } => {
            Some(*finger)
        }
        _ => None,
    }
}
