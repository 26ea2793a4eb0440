//! The number of a finger.

use serde::{Deserialize, Serialize};
use std::fmt;

/// Number of fingers of a hand.
pub const FINGERS: usize = 3;

/// The number of a finger: 1, 2 or 3 in calls, configuration files and texts.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(try_from = "u8", into = "u8")]
pub struct FingerNumber {
    /// The number minus 1, less than [`FINGERS`].
    index: u8,
}

impl FingerNumber {
    /// Finger 1.
    pub const ONE: Self = Self { index: 0 };

    /// Finger 2.
    pub const TWO: Self = Self { index: 1 };

    /// Finger 3.
    pub const THREE: Self = Self { index: 2 };

    /// All fingers, in ascending order.
    pub const ALL: [Self; FINGERS] = [Self::ONE, Self::TWO, Self::THREE];

    /// Returns the finger with this number, or `None` if there is no such finger.
    #[must_use]
    pub fn new(number: i32) -> Option<Self> {
        Self::ALL.into_iter().find(|finger| finger.get() == number)
    }

    /// Returns the number, 1 to 3.
    #[must_use]
    pub const fn get(self) -> i32 {
        self.index as i32 + 1
    }

    /// Returns the place of the finger in an array of all fingers, 0 to 2.
    #[must_use]
    pub const fn index(self) -> usize {
        self.index as usize
    }
}

impl From<FingerNumber> for u8 {
    fn from(finger: FingerNumber) -> Self {
        finger.index + 1
    }
}

impl TryFrom<u8> for FingerNumber {
    type Error = String;

    fn try_from(number: u8) -> Result<Self, Self::Error> {
        Self::new(number.into()).ok_or_else(|| format!("there is no finger {number}: fingers are 1, 2 and 3"))
    }
}

impl fmt::Display for FingerNumber {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        self.get().fmt(formatter)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_run_from_one_to_three_and_index_arrays_of_fingers() {
        for (index, finger) in FingerNumber::ALL.into_iter().enumerate() {
            assert_eq!((finger.index(), finger.get() as usize), (index, index + 1));
            assert_eq!(FingerNumber::new(finger.get()), Some(finger));
            assert_eq!(finger.to_string(), (index + 1).to_string());
        }
        for number in [i32::MIN, -1, 0, 4, i32::MAX] {
            assert_eq!(FingerNumber::new(number), None);
        }
    }
}
