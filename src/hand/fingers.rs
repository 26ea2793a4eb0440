//! The selection of a hand's fingers that are opened.

use crate::hand::HandError;
use crate::model::configuration::FINGERS;

/// A selection of at least one finger. The ports of other fingers are not opened, and calls for other fingers are
/// refused with [`HandError::NotOpened`]. The configuration still describes the whole hand, and all of it is checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fingers([bool; FINGERS]);

impl Fingers {
    /// Every finger.
    pub const ALL: Self = Self([true; FINGERS]);

    /// Only finger 1, 2 or 3.
    ///
    /// # Errors
    /// No such finger.
    pub fn only(finger: i32) -> Result<Self, HandError> {
        Self([false; FINGERS]).and(finger)
    }

    /// This selection and finger 1, 2 or 3.
    ///
    /// # Errors
    /// No such finger.
    pub fn and(mut self, finger: i32) -> Result<Self, HandError> {
        let index = usize::try_from(finger).ok().and_then(|number| number.checked_sub(1));
        *index.and_then(|index| self.0.get_mut(index)).ok_or(HandError::NoSuchFinger(finger))? = true;
        Ok(self)
    }

    /// The fingers with these numbers, 1 to 3. An empty list selects every finger.
    ///
    /// # Errors
    /// No such finger.
    pub fn of(numbers: &[i32]) -> Result<Self, HandError> {
        match numbers {
            [] => Ok(Self::ALL),
            [first, others @ ..] => others.iter().try_fold(Self::only(*first)?, |fingers, &finger| fingers.and(finger)),
        }
    }

    /// The numbers of the fingers, 1 to 3, in rising order.
    pub fn numbers(self) -> impl Iterator<Item = i32> {
        self.indices().map(|index| index as i32 + 1) // 1 to 3
    }

    /// The indices of the fingers in a configuration, 0 to 2.
    pub(super) fn indices(self) -> impl Iterator<Item = usize> {
        (0..FINGERS).filter(move |&index| self.0[index])
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
        assert_eq!(Fingers::ALL.indices().collect::<Vec<_>>(), [0, 1, 2]);
    }

    #[test]
    fn there_are_three_fingers() {
        for number in [i32::MIN, -1, 0, 4, i32::MAX] {
            assert!(matches!(Fingers::only(number), Err(HandError::NoSuchFinger(refused)) if refused == number));
            assert!(matches!(Fingers::ALL.and(number), Err(HandError::NoSuchFinger(_))));
        }
    }
}
