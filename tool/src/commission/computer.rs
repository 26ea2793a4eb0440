//! The steps that need no motion: the board, the bound of the stiffness, and the computer.

use super::desk::Desk;
use super::machine::{BoardSeen, Bound};
use super::outcome::Outcome;
use super::person::{Act, Answer};
use super::wrong::Wrong;
use crate::failure::Failure;

/// Carries out the step `board`.
pub fn board(desk: &mut Desk) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    let seen = desk.machine.board()?;
    let name = seen.name.clone();
    judge(&mut outcome, seen);
    if !outcome.passed() {
        return Ok(outcome);
    }
    outcome.found(name);
    if desk.person.ask(Act::PressEmergencyStop)? == Answer::Cannot {
        outcome.found("the emergency stop was not tested");
        return Ok(outcome);
    }
    let pressed = desk.machine.board()?;
    desk.person.ask(Act::ReleaseEmergencyStop)?;
    match pressed.emergency_stop || pressed.supply_fault {
        true => outcome.found("the board sees the emergency stop"),
        false => outcome.wrong(Wrong::EmergencyStopUnseen),
    }
    judge(&mut outcome, desk.machine.board()?);
    Ok(outcome)
}

/// Reports why a board does not work.
fn judge(outcome: &mut Outcome, seen: BoardSeen) {
    if seen.emergency_stop {
        outcome.wrong(Wrong::EmergencyStop);
    }
    if seen.supply_fault {
        outcome.wrong(Wrong::Supply);
    }
    if let (Some(refusal), true) = (seen.refusal, outcome.passed()) {
        outcome.wrong(Wrong::Board(refusal));
    }
}

/// Carries out the step `bound`.
pub fn bound(desk: &mut Desk) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    desk.machine.configure(&desk.finger)?;
    let Bound { stiffness: bound, limit } = desk.machine.bound()?;
    desk.finger.stiffness.bound = Some(bound);
    outcome.found(format!("the bound of the stiffness is {bound:.2} N/cm"));
    outcome.found(format!("limited by: {limit}"));
    outcome.about("stiffness.bound", format!("limited by: {limit}"));
    let initial = desk.finger.initial_stiffness().symmetric_eigenvalues().max();
    if initial > bound {
        // Otherwise the finger could not be opened with its new bound.
        desk.finger.stiffness.initial.as_flattened_mut().iter_mut().for_each(|entry| *entry *= bound / initial);
        outcome.about("stiffness.initial", format!("lowered from {initial:.2} N/cm to the bound"));
        outcome.wrong(Wrong::InitialLowered(initial, bound));
    }
    Ok(outcome)
}

/// Carries out the step `computer`.
pub fn computer(desk: &mut Desk) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    let complaints = desk.machine.computer()?;
    if complaints.is_empty() {
        outcome.found("the computer runs the finger in time");
    }
    complaints.into_iter().for_each(|complaint| outcome.wrong(Wrong::Computer(complaint)));
    Ok(outcome)
}
