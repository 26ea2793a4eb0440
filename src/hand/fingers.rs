//! Selects which fingers of a hand are opened, by the numbers that planners use.

use crate::hand::HandError;
use crate::model::configuration::ConfiguredHand;
use crate::model::{FingerNumber, Fingers};

impl Fingers {
    /// Selects only this finger: 1, 2 or 3.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn only(finger: i32) -> Result<Self, HandError> {
        FingerNumber::try_from(finger).map(Self::one)
    }

    /// Adds this finger to the selection: 1, 2 or 3.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn and(self, finger: i32) -> Result<Self, HandError> {
        FingerNumber::try_from(finger).map(|finger| self.with(finger))
    }

    /// Selects the fingers with these numbers, 1 to 3. An empty list selects every finger.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn of(numbers: &[i32]) -> Result<Self, HandError> {
        match numbers {
            [] => Ok(Self::ALL),
            [first, others @ ..] => others.iter().try_fold(Self::only(*first)?, |fingers, &finger| fingers.and(finger)),
        }
    }

    /// Returns the selected fingers of a hand. [`Fingers::ALL`] selects those that the hand has.
    ///
    /// # Errors
    /// Returns an error if the hand does not have a selected finger.
    pub fn in_hand(self, hand: &ConfiguredHand) -> Result<Self, HandError> {
        if self == Self::ALL {
            return Ok(hand.fingers);
        }
        match self.members().find(|&finger| !hand.fingers.contains(finger)) {
            None => Ok(self),
            Some(finger) => Err(HandError::NotInHand { finger, fingers: hand.fingers }),
        }
    }
}

/// Calls take plain numbers, as in C. This conversion checks a number and returns its finger.
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
        let fingers = fingers.expect("fingers 1 and 3");
        assert_eq!(fingers.numbers().collect::<Vec<_>>(), [1, 3]);
        assert_eq!(fingers.to_string(), "[1, 3]");
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

    #[test]
    fn a_hand_opens_only_fingers_that_it_has() {
        let fingers = Fingers::of(&[2, 3]).expect("fingers 2 and 3");
        let hand = ConfiguredHand { fingers, ..Default::default() };
        assert_eq!(Fingers::ALL.in_hand(&hand).expect("all of the hand"), fingers);
        let second = Fingers::only(2).expect("finger 2");
        assert_eq!(second.in_hand(&hand).expect("a finger of the hand"), second);
        let refusal = Fingers::of(&[1, 2]).and_then(|fingers| fingers.in_hand(&hand)).expect_err("finger 1");
        assert!(refusal.to_string().contains("hand.fingers = [2, 3]"), "{refusal}");
    }
}
