//! The text of a fault in a Status.

use std::fmt;

/// The beginning of the text of a fault: at most 71 bytes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FaultText(String);

impl FaultText {
    /// The largest length, bytes.
    pub const LONGEST: usize = 71;

    /// Returns the beginning of this text, cut between two characters.
    #[must_use]
    pub fn beginning_of(text: &str) -> Self {
        let end = (0..=Self::LONGEST.min(text.len())).rev().find(|&end| text.is_char_boundary(end));
        Self(text[..end.unwrap_or(0)].into())
    }

    /// Returns the text before the first colon: the name of the fault, the affected part, and the value of the fault.
    /// The text after the colon may end in the middle of a word. Returns an empty text if there is no colon.
    #[must_use]
    pub fn fault(&self) -> &str {
        self.0.split_once(": ").map_or("", |(fault, _)| fault)
    }

    /// Returns the text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for FaultText {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(formatter)
    }
}
