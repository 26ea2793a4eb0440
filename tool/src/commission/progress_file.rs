//! The steps that are done, and what they found: a JSON file beside the configuration.

use super::outcome::Outcome;
use super::step::Step;
use super::vitals::Vitals;
use crate::failure::Failure;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use sun2xp::files::{read_regular_file, replace_file};
use sun2xp::model::ShownPath;

/// Largest file that is read, bytes.
const LARGEST: u64 = 1 << 20;

/// A step that has passed.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
pub struct Done {
    /// Date and time, UTC.
    pub when: String,
    /// What was found, in the words of the tool.
    pub found: Vec<String>,
}

/// One finger.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Serialize)]
#[serde(default)]
pub struct CommissionedFinger {
    pub steps: BTreeMap<Step, Done>,
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
            Err(error) => return Err(format!("{}: {error}", ShownPath(path)).into()),
        };
        serde_json::from_str(&text).map_err(|error| {
            format!("{} is not a file of sun2xp commission ({error}): move it away to begin anew", ShownPath(path))
                .into()
        })
    }

    /// Adds a step that has passed. The steps after it belong to the finger as it was, and count no longer.
    pub fn note(&mut self, finger: i32, step: Step, outcome: &Outcome, vitals: &Vitals, when: String) {
        let finger = self.fingers.entry(finger).or_default();
        if matches!(step, Step::Encoders | Step::Gauges | Step::Motors) {
            finger.steps.retain(|&other, _| other <= step || matches!(other, Step::Board | Step::Computer));
        }
        let mut found = outcome.found.clone();
        found.extend(outcome.wrong.iter().map(ToString::to_string));
        finger.steps.insert(step, Done { when, found });
        finger.vitals = vitals.clone();
    }

    /// Replaces the file.
    pub fn write(&self, path: &Path) -> Result<(), Failure> {
        let text = serde_json::to_string_pretty(self)? + "\n";
        replace_file(path, |file| file.write_all(text.as_bytes()))
            .map_err(|error| format!("cannot write {}: {error}", ShownPath(path)).into())
    }
}
