//! Reads a black box as a recording of one finger.

use super::altered::{named, unusable};
use super::entry::{Entry, Item};
use crate::failure::Failure;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use sun2xp::finger::{self, CycleRecord, Fault, FaultKind, Origin, Stage};
use sun2xp::model::configuration::Configuration;
use sun2xp::model::{FingerNumber, Part};
use sun2xp::telemetry::{Description, Message};

/// Returns whether a file begins like JSON text, as a black box does. An MCAP file begins with another byte.
pub fn is_one(path: &Path) -> io::Result<bool> {
    let mut first = [0];
    Ok(path.is_file() && File::open(path)?.read(&mut first)? == 1 && first == *b"{")
}

/// Reads a black box.
pub fn read(path: &Path) -> Result<(Description, Vec<Entry>), Failure> {
    let recording = finger::Recording::open(path)?;
    let finger::Recording { origin, library, clock_offset, cycles, .. } = recording;
    check(&origin).map_err(|reason| unusable(path, &library, &reason))?;
    let number = FingerNumber::new(origin.finger).ok_or_else(|| {
        unusable(path, &library, &format!("finger {} does not exist: fingers are 1, 2 and 3", origin.finger))
    })?;
    let mut configuration = Configuration { hand: origin.hand.clone(), ..Default::default() };
    if let Some(first) = origin.controllers.first() {
        configuration.fingers[number.index()] = first.finger.clone();
    }
    let time = |began: u64| began.saturating_add_signed(clock_offset);
    let begin = cycles.first().map_or(0, |record| record.began);
    let description = Description {
        name: "black box".into(),
        process: 0,
        library,
        // The black box does not have the time at which the hand was opened.
        started: time(begin) / 1_000_000_000,
        clock_offset,
        fingers: vec![number],
        configuration,
    };
    let mut entries = Vec::new();
    let mut add = |began, message| entries.push(Entry { time: time(began), item: Item::Message(message) });
    for source in origin.controllers {
        let hand = Box::new(origin.hand.clone());
        add(begin, Message::Controller { finger: number, source: Box::new(source), hand });
    }
    if let Some(first) = cycles.first() {
        add(begin, Message::Keyframe { finger: number, cycle: first.cycle, state: Box::new(origin.state) });
    }
    for record in cycles {
        let CycleRecord { cycle, began, stage, timing, feedback, status, control } = record;
        let stage = stage_of(&stage).ok_or_else(|| {
            unusable(path, &description.library, &format!("cycle {cycle} has the unknown stage \"{stage}\""))
        })?;
        let record = CycleRecord { cycle, began, stage, timing, feedback, status, control };
        add(began, Message::Cycle { finger: number, record });
    }
    Ok((description, entries))
}

/// Checks the configurations. An altered file may have any values. The commands that draw and convert a recording
/// expect values that a hand may have.
fn check(origin: &Origin) -> Result<(), String> {
    origin.hand.check().map_err(|wrong| named(&wrong))?;
    let mut fingers = origin.controllers.iter().map(|source| &source.finger);
    fingers.try_for_each(|finger| finger.check().map_err(|wrong| named(&wrong)))
}

/// Returns the stage that has this text in a black box.
fn stage_of(text: &str) -> Option<Stage> {
    let stages = [Stage::Opening, Stage::Limp, Stage::Calibrating, Stage::Running, Stage::Closing, Stage::Closed];
    let plain = stages.into_iter().find(|stage| stage.to_string() == text);
    plain.or_else(|| text.strip_prefix("faulted: ").and_then(fault_of).map(Stage::Faulted))
}

/// Returns the fault that has this text: name, part if there is one, value in brackets if there is one.
fn fault_of(text: &str) -> Option<Fault> {
    let begins = |kind: &FaultKind| {
        let rest = text.strip_prefix(kind.description().name)?;
        (rest.starts_with(", ") || rest.starts_with(": ") || rest.starts_with(" (")).then_some((*kind, rest))
    };
    let (kind, rest) = FaultKind::ALL.iter().find_map(begins)?;
    let head = rest.split(':').next().unwrap_or_default();
    let mut fault = Fault::new(kind);
    let parts = (0..4).flat_map(|index| {
        [Part::joint(index), Part::tendon(index), Part::motor(index), Part::gauge(index), Part::encoder(index)]
    });
    let named = head.trim_start_matches(", ").split(" (").next().unwrap_or_default();
    fault.part = parts.into_iter().find(|part| part.to_string() == named).unwrap_or(Part::Finger);
    let value = head.split_once('(').and_then(|(_, value)| {
        let digits = value.trim_start_matches(|letter: char| letter.is_ascii_alphabetic() || letter == ' ');
        let number = digits.split([' ', ')']).next()?;
        match number.strip_prefix("0x") {
            Some(bits) => u16::from_str_radix(bits, 16).ok().map(f64::from),
            None => number.parse().ok(),
        }
    });
    fault.value = value.unwrap_or_default();
    Some(fault)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_are_read_from_their_texts() {
        let mut broken = Fault::new(FaultKind::BrokenTendon);
        (broken.part, broken.value) = (Part::Tendon(3), 0.5);
        let stopped = Fault::of(FaultKind::BoardStopped, 72.0);
        let stages = [Stage::Opening, Stage::Running, Stage::Closed, Stage::Faulted(broken), Stage::Faulted(stopped)];
        for stage in stages {
            assert_eq!(stage_of(&stage.to_string()), Some(stage), "{stage}");
        }
        for &kind in FaultKind::ALL {
            let stage = Stage::Faulted(Fault::new(kind));
            let found = stage_of(&stage.to_string());
            assert!(matches!(found, Some(Stage::Faulted(fault)) if fault.kind == kind), "{stage}: {found:?}");
        }
        assert_eq!(stage_of("asleep"), None);
    }
}
