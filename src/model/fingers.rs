//! Which of the three fingers a hand has, and which of them a program opens.

use super::finger_number::{FINGERS, FingerNumber};
use serde::{Deserialize, Serialize};
use std::fmt;

/// A selection of at least one finger. In `hand.fingers` it lists the fingers that the hand has. At open it selects the
/// fingers to open: the ports of other fingers are not opened, and calls for other fingers are refused.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[serde(try_from = "Vec<FingerNumber>", into = "Vec<FingerNumber>")]
#[must_use]
pub struct Fingers([bool; FINGERS]);

impl Fingers {
    /// All three fingers. At open it selects every finger that the hand has.
    pub const ALL: Self = Self([true; FINGERS]);

    /// Selects one finger.
    pub fn one(finger: FingerNumber) -> Self {
        Self([false; FINGERS]).with(finger)
    }

    /// Adds a finger to the selection.
    pub fn with(mut self, finger: FingerNumber) -> Self {
        self.0[finger.index()] = true;
        self
    }

    /// Returns whether the finger is selected.
    #[must_use]
    pub fn contains(self, finger: FingerNumber) -> bool {
        self.0[finger.index()]
    }

    /// Returns the numbers of the selected fingers, 1 to 3, in rising order.
    pub fn numbers(self) -> impl Iterator<Item = i32> {
        self.members().map(FingerNumber::get)
    }

    /// Returns the selected fingers, in the order of their numbers.
    pub fn members(self) -> impl Iterator<Item = FingerNumber> {
        FingerNumber::ALL.into_iter().filter(move |&finger| self.contains(finger))
    }
}

impl TryFrom<Vec<FingerNumber>> for Fingers {
    type Error = &'static str;

    fn try_from(numbers: Vec<FingerNumber>) -> Result<Self, Self::Error> {
        let Some((&first, others)) = numbers.split_first() else {
            return Err("a hand has at least one finger: list the numbers of its fingers, for example [2]");
        };
        others.iter().try_fold(Self::one(first), |fingers, &finger| match fingers.contains(finger) {
            true => Err("a finger is listed twice: list each finger once, for example [1, 3]"),
            false => Ok(fingers.with(finger)),
        })
    }
}

impl From<Fingers> for Vec<FingerNumber> {
    fn from(fingers: Fingers) -> Self {
        fingers.members().collect()
    }
}

/// Writes the selection as it is written in a configuration file: `[1, 3]`.
impl fmt::Display for Fingers {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.debug_list().entries(self.numbers()).finish()
    }
}
