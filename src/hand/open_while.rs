//! Opens a hand for a program that may end meanwhile.

use crate::hand::hardware::Hardware;
use crate::hand::{Configured, Hand, HandError};
use crate::model::Fingers;

impl Hand {
    /// Does the same as [`Hand::open_as`], but gives up if `goes_on` returns false. Calls `goes_on` before the motors
    /// can pull, and then every millisecond until the tendons are taut. Before the first call every motor is off. With
    /// `hand.self_test`, the self-test tightens the tendons, and `goes_on` is not called during the self-test.
    ///
    /// # Errors
    /// Returns the errors of [`Hand::open_as`], and [`HandError::System`] with `ECANCELED` if `goes_on` returns false.
    pub fn open_while(configured: Configured, goes_on: &dyn Fn() -> bool) -> Result<Self, HandError> {
        let configured = configured.local()?;
        configured.announce(Fingers::ALL);
        Self::open_from(configured.configuration, configured.file, Fingers::ALL, Hardware::default(), false, goes_on)
    }
}
