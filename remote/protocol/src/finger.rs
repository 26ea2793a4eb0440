//! The number of a finger.

use crate::error::{FieldError, within};
use std::fmt;

/// The largest number of fingers of a hand.
pub const FINGERS: usize = 3;

/// The number of a finger: 1, 2 or 3.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Finger(u8);

impl Finger {
    /// All fingers, in rising order.
    pub const ALL: [Finger; FINGERS] = [Finger(1), Finger(2), Finger(3)];

    /// Returns the finger with this number; none if there is no such finger.
    #[must_use]
    pub fn new(number: i32) -> Option<Self> {
        (1..=3).contains(&number).then_some(Self(number as u8))
    }

    /// The number, 1 to 3.
    #[must_use]
    pub fn number(self) -> u8 {
        self.0
    }

    /// The index of the finger in an array, 0 to 2.
    #[must_use]
    pub fn index(self) -> usize {
        usize::from(self.0) - 1
    }

    pub(crate) fn decode(number: u8) -> Result<Self, FieldError> {
        within("finger", u64::from(number), 1, 3)?;
        Ok(Self(number))
    }
}

impl fmt::Display for Finger {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(formatter)
    }
}
