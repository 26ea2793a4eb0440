//! Fingers whose hardware the program provides. The configuration file has no key for such fingers.

use super::ConfiguredFinger;

/// Beginning of the port of a finger whose hardware the program provides. The number of the finger follows.
pub const IO_PORT: &str = "sun2xp_io:";

impl ConfiguredFinger {
    /// Returns whether the program provides the hardware of the finger, so that there is no serial port.
    #[must_use]
    pub fn has_io(&self) -> bool {
        self.port.starts_with(IO_PORT)
    }
}
