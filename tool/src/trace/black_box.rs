//! Black boxes as rows.

use super::{Changes, Finger, Item, Row, Visit};
use crate::failure::Failure;
use std::path::Path;
use sun2xp::finger::{CycleRecord, Origin, Recording, Stage};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::telemetry::View;

/// Reads a black box of one finger.
pub fn read(file: &Path, visit: Visit) -> Result<(), Failure> {
    let recording = Recording::open(file)?;
    let Origin { finger, hand, controllers, .. } = &recording.origin;
    let number = FingerNumber::try_from(*finger)?;
    let mut configuration = Configuration { hand: hand.clone(), ..Configuration::default() };
    // The pose of the finger in the palm does not change while it runs.
    if let Some(first) = controllers.first() {
        configuration.fingers[number.index()] = first.finger.clone();
    }
    let mut view = View::new(&configuration);
    controllers.iter().for_each(|source| view.note_controller(number, source));
    visit(Item::Finger(Finger { number: *finger, rate: hand.rate }))?;
    let mut changes = Changes::default();
    for cycle in &recording.cycles {
        let row = Row {
            sample: view.sample(number, &with_stage(cycle)),
            stage: cycle.stage.clone(),
            feedback: cycle.feedback,
            status: cycle.status,
        };
        changes.before(&row).into_iter().try_for_each(|mark| visit(Item::Mark(mark)))?;
        visit(Item::Cycle(Box::new(row)))?;
    }
    Ok(())
}

/// A black box has the text of a fault, but not its parts. A sample depends only on whether the finger runs, so a
/// faulted finger counts as closed. The text of the stage stays in the row.
fn with_stage(cycle: &CycleRecord<String>) -> CycleRecord {
    let stages = [Stage::Opening, Stage::Limp, Stage::Calibrating, Stage::Running, Stage::Closing];
    let stage = stages.into_iter().find(|stage| stage.to_string() == cycle.stage).unwrap_or(Stage::Closed);
    let CycleRecord { cycle, began, timing, feedback, status, control, .. } = *cycle;
    CycleRecord { cycle, began, stage, timing, feedback, status, control }
}
