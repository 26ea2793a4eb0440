//! Numbers of the kinds of faults.

use super::table::FaultKind;

impl FaultKind {
    /// Returns the number of the kind, counted from 1. It is the same in every version of this library.
    #[must_use]
    pub fn number(self) -> u8 {
        self as u8
    }

    /// Returns the kind with this number.
    #[must_use]
    pub fn from_number(number: i32) -> Option<Self> {
        Self::ALL.iter().copied().find(|kind| i32::from(kind.number()) == number)
    }
}
