//! The result of a step.

use super::wrong::Wrong;

/// What a step has found.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// What was measured, with residuals.
    pub found: Vec<String>,
    /// What is wrong or unexpected.
    pub wrong: Vec<Wrong>,
}

impl Outcome {
    /// Adds a measurement.
    pub fn found(&mut self, line: impl Into<String>) {
        self.found.push(line.into());
    }

    /// Adds something that is wrong, once.
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
