//! Checks of `[telemetry]`.

use super::ranges::unusable;
use crate::model::Shown;
use crate::model::configuration::{ConfiguredTelemetry, Unusable};

/// Largest length of a hand's name. The name of the socket must have room for it, the user ID and a suffix.
const LONGEST_NAME: usize = 32;

impl ConfiguredTelemetry {
    /// Checks the name of the hand.
    ///
    /// # Errors
    /// Returns an error if the name is empty or too long, or if it contains a character that is not permitted.
    pub fn check(&self) -> Result<(), Unusable> {
        let permitted = |letter: char| letter.is_ascii_alphanumeric() || letter == '-' || letter == '_';
        if (1..=LONGEST_NAME).contains(&self.name.len()) && self.name.chars().all(permitted) {
            return Ok(());
        }
        let reason = format!(
            "\"{}\" is not a valid name of a hand: use 1 to {LONGEST_NAME} characters from A-Z, a-z, 0-9, - and _",
            Shown(&self.name)
        );
        unusable("name", reason)
    }
}
