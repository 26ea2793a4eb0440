//! The result of a step.

use super::step::Step;
use super::wrong::Wrong;

/// What a step has found.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// What was measured, with residuals.
    pub found: Vec<String>,
    /// What is wrong or unexpected.
    pub wrong: Vec<Wrong>,
    /// Results for the comments above the keys, each with its section and key, for example "gauge.zero".
    pub keys: Vec<(&'static str, String)>,
}

impl Outcome {
    /// Adds a measurement.
    pub fn found(&mut self, line: impl Into<String>) {
        self.found.push(line.into());
    }

    /// Adds the result from which the value of a configuration key follows, for the comment above this key.
    pub fn about(&mut self, key: &'static str, text: impl Into<String>) {
        self.keys.push((key, text.into()));
    }

    /// The comment above a key: date, step and result. For a key without a result of its own, it is only date and step.
    pub fn comment(&self, key: &str, step: Step, when: &str) -> String {
        match self.keys.iter().find(|(other, _)| *other == key) {
            Some((_, text)) => format!("{when}, {step}: {text}"),
            None => format!("{when}, {step}"),
        }
    }

    /// Adds something that is wrong, unless it was added before.
    pub fn wrong(&mut self, wrong: Wrong) {
        if !self.wrong.contains(&wrong) {
            self.wrong.push(wrong);
        }
    }

    /// Whether the next step can begin: nothing is wrong that a person must repair.
    pub fn passed(&self) -> bool {
        self.wrong.iter().all(Wrong::compensated)
    }
}
