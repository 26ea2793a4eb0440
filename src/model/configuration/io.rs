//! Fingers whose hardware the calling program drives (`FingerIo`). The configuration file has no key for such fingers.

use super::ConfiguredFinger;
use crate::model::finger_number::FingerNumber;

/// Prefix of the value of `port` for a finger whose hardware the program provides. The number of the finger follows the
/// prefix.
const IO_PORT: &str = "sun2xp_io:";

impl ConfiguredFinger {
    /// Returns whether the program provides the hardware of the finger, so that there is no serial port.
    #[must_use]
    pub fn has_io(&self) -> bool {
        self.port.starts_with(IO_PORT)
    }

    /// Replaces the port of the finger with this number by hardware that the program provides.
    pub fn provide(&mut self, number: FingerNumber) {
        (self.port, self.board) = (format!("{IO_PORT}{number}"), None);
    }
}
