//! Black boxes as rows.

use super::{Changes, Finger, Item, Row, Sample, Visit};
use crate::failure::Failure;
use std::path::Path;
use sun2xp::finger::Recording;

/// Reads a black box of one finger.
pub fn read(file: &Path, visit: Visit) -> Result<(), Failure> {
    let recording = Recording::open(file)?;
    let origin = &recording.origin;
    visit(Item::Finger(Finger { number: origin.finger, rate: origin.hand.rate }))?;
    let mut changes = Changes::default();
    for cycle in &recording.cycles {
        let row = Row {
            sample: Sample::new(origin, cycle),
            stage: cycle.stage.clone(),
            feedback: cycle.feedback,
            status: cycle.status,
        };
        changes.before(&row).into_iter().try_for_each(|mark| visit(Item::Mark(mark)))?;
        visit(Item::Cycle(Box::new(row)))?;
    }
    Ok(())
}
