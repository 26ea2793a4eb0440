//! Opens a hand with hardware that the program provides.

use crate::board::HandIo;
use crate::hand::hardware::Hardware;
use crate::hand::{Configured, Hand, HandError};
use crate::model::Fingers;
use crate::model::configuration::Configuration;

impl Hand {
    /// Opens the hand with hardware that the program provides for some fingers, instead of boards at serial ports. The
    /// configured ports of these fingers are ignored. `io` has the hardware of fingers 1, 2 and 3.
    ///
    /// # Errors
    /// Returns the errors of [`Hand::open`]. Returns an error if the step in which the hardware's tensions are stored
    /// (`IoProperties::tension_unit`) does not fit the configured gauges.
    pub fn open_with_io(configuration: Configuration, io: HandIo) -> Result<Self, HandError> {
        Self::open_from(configuration, None, Fingers::ALL, Hardware::new(io), false, &|| true)
    }

    /// Does the same as [`Hand::open_with_io`] for a configuration that may come from a file. If it does, calibration
    /// results are stored in that file.
    pub(crate) fn open_as_with_io(mut configured: Configured, io: HandIo) -> Result<Self, HandError> {
        let hardware = Hardware::new(io);
        hardware.members().for_each(|finger| configured.provides(finger));
        configured.announce(Fingers::ALL);
        Self::open_from(configured.configuration, configured.file, Fingers::ALL, hardware, false, &|| true)
    }
}
