//! Selects which fingers of a hand are opened.

use crate::hand::HandError;
use crate::model::FingerNumber;
use crate::model::configuration::FINGERS;

/// A selection of at least one finger. The ports of other fingers are not opened, and calls for other fingers are
/// refused with [`HandError::NotOpened`]. The configuration still describes the whole hand, and all of it is checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[must_use]
pub struct Fingers([bool; FINGERS]);

impl Fingers {
    /// Every finger.
    pub const ALL: Self = Self([true; FINGERS]);

    /// Selects only this finger: 1, 2 or 3.
    ///
    /// # Errors
    /// There is no such finger.
    pub fn only(finger: i32) -> Result<Self, HandError> {
        Self([false; FINGERS]).and(finger)
    }

    /// Adds this finger to the selection: 1, 2 or 3.
    ///
    /// # Errors
    /// There is no such finger.
    pub fn and(mut self, finger: i32) -> Result<Self, HandError> {
        self.0[FingerNumber::try_from(finger)?.index()] = true;
        Ok(self)
    }

    /// Selects the fingers with these numbers, 1 to 3. An empty list selects every finger.
    ///
    /// # Errors
    /// There is no such finger.
    pub fn of(numbers: &[i32]) -> Result<Self, HandError> {
        match numbers {
            [] => Ok(Self::ALL),
            [first, others @ ..] => others.iter().try_fold(Self::only(*first)?, |fingers, &finger| fingers.and(finger)),
        }
    }

    /// The numbers of the fingers, 1 to 3, in rising order.
    pub fn numbers(self) -> impl Iterator<Item = i32> {
        self.members().map(FingerNumber::get)
    }

    /// Returns the fingers, in the order of their numbers.
    pub(super) fn members(self) -> impl Iterator<Item = FingerNumber> {
        FingerNumber::ALL.into_iter().filter(move |finger| self.0[finger.index()])
    }
}

/// Calls take plain numbers, as in C. Here they become fingers.
impl TryFrom<i32> for FingerNumber {
    type Error = HandError;

    fn try_from(number: i32) -> Result<Self, HandError> {
        Self::new(number).ok_or(HandError::NoSuchFinger(number))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fingers_are_counted_once_and_in_order() {
        let fingers = Fingers::only(3).and_then(|fingers| fingers.and(1)).and_then(|fingers| fingers.and(3));
        assert_eq!(fingers.expect("fingers 1 and 3").numbers().collect::<Vec<_>>(), [1, 3]);
        assert_eq!(Fingers::of(&[2, 1, 2]).expect("fingers 1 and 2").numbers().collect::<Vec<_>>(), [1, 2]);
        assert_eq!(Fingers::of(&[]).expect("every finger"), Fingers::ALL);
        assert_eq!(Fingers::ALL.members().collect::<Vec<_>>(), FingerNumber::ALL);
    }

    #[test]
    fn there_are_three_fingers() {
        for number in [i32::MIN, -1, 0, 4, i32::MAX] {
            assert!(matches!(Fingers::only(number), Err(HandError::NoSuchFinger(refused)) if refused == number));
            assert!(matches!(Fingers::ALL.and(number), Err(HandError::NoSuchFinger(_))));
        }
    }
}
