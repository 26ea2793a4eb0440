//! The tactile elements of the fingertips: their newest readings, and their tare.

use crate::finger::TouchReading;
use crate::hand::{Hand, HandError};
use crate::model::FingerNumber;

impl Hand {
    /// The newest reading of a tactile element of finger 1, 2 or 3. Elements are numbered from 0, in the order of
    /// `[finger.touch]`. The servo fetches one tactile event of a finger in each period in which the line has time for
    /// it.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if it has no such element.
    pub fn touch(&self, finger: i32, element: usize) -> Result<TouchReading, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let elements = &self.dispatcher.member(finger)?.touch;
        let count = elements.count();
        elements.reading(element).ok_or(HandError::NoSuchElement { finger, element, count })
    }

    /// The number of tactile events of finger 1, 2 or 3 that were lost since open: those that did not fit into the
    /// queue of the board, and those of elements that are not configured.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn lost_touch_events(&self, finger: i32) -> Result<u64, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let elements = &self.dispatcher.member(finger)?.touch;
        Ok(elements.lost() + elements.unknown())
    }

    /// Tares the tactile elements of finger 1, 2 or 3: the newest count of each element becomes its zero. An element
    /// without a valid reading keeps its zero. The zeros are in force until the hand is closed. To keep them, write the
    /// result of [`Hand::touch_zeros`] as `zero` into `[finger.touch]`. The call does not allocate.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn tare_touch(&self, finger: i32) -> Result<(), HandError> {
        let finger = FingerNumber::try_from(finger)?;
        self.dispatcher.member(finger)?.touch.tare();
        Ok(())
    }

    /// Returns the zeros of the tactile elements of finger 1, 2 or 3, counts.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn touch_zeros(&self, finger: i32) -> Result<Vec<u16>, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        Ok(self.dispatcher.member(finger)?.touch.zeros())
    }
}
