//! One run of the tool: carries out steps, and stores what they find.

use super::DEFAULT_WEIGHTS;
use super::configuration_file;
use super::desk::Desk;
use super::outcome::Outcome;
use super::person::NoAnswer;
use super::progress_file::{CommissionedFinger, ProgressFile};
use super::step::Step;
use crate::failure::Failure;
use crate::monitor::words::utc;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::model::{FingerNumber, ShownPath};

/// The finger and the files of a commissioning.
pub struct Session<'a> {
    pub config: &'a Path,
    pub finger: FingerNumber,
    /// The masses of the weights, kg.
    pub weights: &'a [f64],
    /// The file with the steps that are done.
    pub file: PathBuf,
}

impl Session<'_> {
    /// Completes a step and stores its results. Returns whether it has passed.
    pub fn carry_out(&self, desk: &mut Desk, step: Step) -> Result<bool, Failure> {
        let known = ProgressFile::read(&self.file)?.fingers.remove(&self.finger.get()).unwrap_or_default();
        if let Some(fault) = known.open_fault(step) {
            return Err(self.stopped(&fault).into());
        }
        let before = desk.finger.clone();
        let failed = |outcome: &Outcome| self.note(|finger| finger.fail(step, outcome, &now()));
        let outcome = match desk.complete(step, failed) {
            Ok(outcome) => outcome,
            Err(failure) if matches!(failure.downcast_ref(), Some(NoAnswer::Left)) => {
                writeln!(io::stdout(), "\nYou have left the step. {}", self.continuation())?;
                return Ok(false);
            }
            Err(failure) => return Err(self.stopped(&failure.to_string()).into()),
        };
        if !outcome.passed() {
            writeln!(io::stdout(), "\n{}", self.continuation())?;
            return Ok(false);
        }
        self.store(desk, step, &before, &outcome)?;
        Ok(true)
    }

    fn store(&self, desk: &Desk, step: Step, before: &ConfiguredFinger, outcome: &Outcome) -> Result<(), Failure> {
        let when = now();
        let comment = |key: &str| outcome.comment(key, step, &when);
        configuration_file::store(self.config, self.finger.get(), before, &desk.finger, &comment)?;
        self.note(|finger| finger.pass(step, outcome, &desk.vitals, &when))
    }

    /// Changes the notes about the finger.
    fn note(&self, mut change: impl FnMut(&mut CommissionedFinger)) -> Result<(), Failure> {
        ProgressFile::update(&self.file, |file| change(file.fingers.entry(self.finger.get()).or_default()))
    }

    /// What to say after the last step: whether the finger is commissioned, or which steps are left.
    pub fn closing(&self) -> Result<String, Failure> {
        let left = ProgressFile::read(&self.file)?.left(self.finger.get());
        if left.is_empty() {
            let later = "Later, run sun2xp health to compare the finger with its state of today.";
            return Ok(format!("The finger is commissioned. {later}"));
        }
        let names = left.iter().map(|step| step.name()).collect::<Vec<_>>().join(", ");
        Ok(format!("The finger is not commissioned yet. Steps left: {names}. {}", self.continuation()))
    }

    /// A failure and how to go on, in one line.
    fn stopped(&self, failure: &str) -> String {
        format!("{}. {}", failure.trim_end_matches('.'), self.continuation())
    }

    /// How to go on later.
    fn continuation(&self) -> String {
        let (config, finger) = (ShownPath(self.config), self.finger);
        let weights = match self.weights == DEFAULT_WEIGHTS {
            true => String::new(),
            false => {
                let masses: Vec<_> = self.weights.iter().map(f64::to_string).collect();
                format!(" --weights {}", masses.join(","))
            }
        };
        format!("The motors are off. To continue: sun2xp commission --config {config} --finger {finger}{weights}")
    }
}

/// The date and time, UTC.
fn now() -> String {
    // If the clock shows a time before 1970, it is wrong, and the beginning of 1970 is noted instead.
    utc(SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs()))
}
