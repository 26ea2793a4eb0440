//! The steps that are done, and what they found: a JSON file beside the configuration.

use super::outcome::Outcome;
use super::step::Step;
use super::vitals::Vitals;
use super::wrong::Wrong;
use crate::failure::{Failure, unwritable};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::OpenOptions;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use sun2xp::files::{UpdateError, read_regular_file, update_file};
use sun2xp::model::ShownPath;

/// Largest file that is read, bytes.
const LARGEST: u64 = 1 << 20;

/// The last attempt at a step, whether the step passed or not.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Done {
    /// Date and time, UTC.
    pub when: String,
    /// What was found, in the words of the tool: all findings of a step that has passed, and the errors of one that has
    /// not.
    pub found: Vec<String>,
}

/// One finger.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
#[serde(default)]
pub struct CommissionedFinger {
    /// The steps that have passed.
    pub steps: BTreeMap<Step, Done>,
    /// The steps that did not pass in their last attempt, with what was wrong.
    pub failed: BTreeMap<Step, Done>,
    pub vitals: Vitals,
}

/// The whole file.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct ProgressFile {
    /// The fingers by their numbers.
    pub fingers: BTreeMap<i32, CommissionedFinger>,
}

/// The file that belongs to a configuration file: hand.toml has hand.commission.json.
pub fn path_beside(configuration: &Path) -> PathBuf {
    configuration.with_extension("commission.json")
}

impl ProgressFile {
    /// Reads the file. A file that does not exist is empty.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let text = match read_regular_file(path, LARGEST) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Self::default()),
            Err(error) => {
                let text = format!(
                    "cannot read {}: {error}. Make the file readable for this user, or move it away to begin anew",
                    ShownPath(path)
                );
                return Err(text.into());
            }
        };
        Self::parse(&text, path)
    }

    fn parse(text: &str, path: &Path) -> Result<Self, Failure> {
        // A process creates the file empty, and writes it afterwards.
        if text.is_empty() {
            return Ok(Self::default());
        }
        serde_json::from_str(text).map_err(|error| {
            format!("{} is not a file of sun2xp commission ({error}): move it away to begin anew", ShownPath(path))
                .into()
        })
    }

    /// Reads, changes and replaces the file under a lock, so that several processes can commission fingers of one hand
    /// at the same time.
    pub fn update(path: &Path, mut change: impl FnMut(&mut Self)) -> Result<(), Failure> {
        let file = |error: io::Error| unwritable(path, &error);
        match OpenOptions::new().write(true).create_new(true).open(path) {
            Err(error) if error.kind() != ErrorKind::AlreadyExists => return Err(file(error)),
            _ => {}
        }
        let changed = |text: &str| {
            let mut progress = Self::parse(text, path)?;
            change(&mut progress);
            Ok(Some(serde_json::to_string_pretty(&progress)? + "\n"))
        };
        update_file(path, LARGEST, changed).map_err(|error| match error {
            UpdateError::File(error) => file(error),
            UpdateError::Change(failure) => failure,
        })
    }

    /// Removes the notes about a finger that was just added to the configuration file. They are about an earlier finger
    /// with this number, whose results the configuration file does not contain.
    pub fn forget(path: &Path, finger: i32) -> Result<(), Failure> {
        match Self::read(path)?.fingers.contains_key(&finger) {
            true => Self::update(path, |file| drop(file.fingers.remove(&finger))),
            false => Ok(()),
        }
    }

    /// The steps of a finger that have not passed yet.
    pub fn left(&self, finger: i32) -> Vec<Step> {
        let passed = |step: &Step| self.fingers.get(&finger).is_some_and(|finger| finger.steps.contains_key(step));
        Step::ALL.into_iter().filter(|step| !passed(step)).collect()
    }
}

impl CommissionedFinger {
    /// Adds a step that has passed. If it is one of the steps encoders, gauges, motors or tendons, the later steps no
    /// longer count, because they belong to the finger as it was before.
    pub fn pass(&mut self, step: Step, outcome: &Outcome, vitals: &Vitals, when: &str) {
        if matches!(step, Step::Encoders | Step::Gauges | Step::Motors | Step::Tendons) {
            self.steps.retain(|&other, _| other <= step);
        }
        let mut found = outcome.found.clone();
        found.extend(outcome.wrong.iter().map(ToString::to_string));
        self.steps.insert(step, Done { when: when.into(), found });
        self.failed.remove(&step);
        self.vitals = vitals.clone();
    }

    /// Adds a step that has not passed. It no longer counts as passed, even if it had passed before.
    pub fn fail(&mut self, step: Step, outcome: &Outcome, when: &str) {
        let wrong = outcome.wrong.iter().filter(|wrong| !wrong.compensated());
        self.steps.remove(&step);
        self.failed.insert(step, Done { when: when.into(), found: wrong.map(Wrong::with_remedy).collect() });
    }

    /// Why a step must not be done: it moves the finger, and an earlier step has found a fault that is still open.
    pub fn open_fault(&self, step: Step) -> Option<String> {
        let (open, fault) = self.failed.iter().find(|&(&open, _)| step.moves() && open < step)?;
        Some(format!(
            "the step \"{step}\" moves the finger. It is not done, because the step \"{open}\" failed on {}: {}. \
             Remove the cause and do the step \"{open}\" again",
            fault.when,
            fault.found.join("; ")
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::thread;

    /// Each session reads and replaces the whole file, and adds only the steps of its own finger.
    #[test]
    fn sessions_for_different_fingers_keep_the_notes_of_each_other() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("hand.commission.json");
        let session = |finger: i32| {
            for step in Step::ALL {
                let pass = |file: &mut ProgressFile| {
                    let finger = file.fingers.entry(finger).or_default();
                    finger.pass(step, &Outcome::default(), &Vitals::default(), "today");
                };
                ProgressFile::update(&path, pass).expect("written");
            }
        };
        thread::scope(|scope| (1..=3).for_each(|finger| drop(scope.spawn(move || session(finger)))));
        let file = ProgressFile::read(&path).expect("read");
        for finger in 1..=3 {
            assert_eq!(file.left(finger), [], "finger {finger}: {file:?}");
        }
    }

    #[test]
    fn an_open_fault_blocks_later_steps_that_move_the_finger() {
        let mut finger = CommissionedFinger::default();
        let (good, vitals) = (Outcome::default(), Vitals::default());
        for step in [Step::Board, Step::Motors] {
            finger.pass(step, &good, &vitals, "yesterday");
        }
        let mut bad = Outcome::default();
        bad.wrong(Wrong::MotorsExchanged(1, 2));
        bad.wrong(Wrong::MotorReversed(3));
        finger.fail(Step::Motors, &bad, "today");
        assert!(!finger.steps.contains_key(&Step::Motors));
        for step in [Step::Zeros, Step::Tendons, Step::Spring] {
            let fault = finger.open_fault(step).expect("refused");
            let named = fault.contains("the step \"motors\" failed on today: motors 1 and 2 are swapped. Swap");
            assert!(named && !fault.contains("backwards"), "{fault}");
        }
        for step in [Step::Board, Step::Encoders, Step::Gauges, Step::Motors, Step::Bound] {
            assert_eq!(finger.open_fault(step), None, "{step}");
        }
        finger.pass(Step::Motors, &good, &vitals, "today");
        assert_eq!(finger.open_fault(Step::Zeros), None);
        for step in [Step::Zeros, Step::Tendons, Step::Bound, Step::Spring, Step::Tendons] {
            finger.pass(step, &good, &vitals, "today");
        }
        assert!(!finger.steps.contains_key(&Step::Bound), "the bound belongs to the tendons as they were before");
    }
}
