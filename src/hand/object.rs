//! The object in the simulated hand.

use crate::hand::{Hand, HandError};
use crate::simulated::ObjectState;

impl Hand {
    /// Returns the state of the object that the simulated fingers touch (`[hand.simulated_object]`), as it was at most
    /// some milliseconds ago.
    ///
    /// # Errors
    /// Returns an error if no object is configured, or if no finger of the open hand is simulated.
    pub fn object(&self) -> Result<ObjectState, HandError> {
        self.simulated.object().ok_or(HandError::NoObject)
    }
}
