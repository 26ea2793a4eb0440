//! The unique numbers of the boards of a hand. The check at open requires that boards at different ports have different
//! numbers.

use crate::board::protocol::Identity;
use crate::hand::HandError;
use crate::model::FingerNumber;
use crate::model::configuration::BoardNumber;
use std::path::{Path, PathBuf};

/// The boards found so far.
#[derive(Default)]
pub(super) struct Identities(Vec<KnownNumber>);

struct KnownNumber {
    /// Number of the finger, 1 to 3.
    finger: FingerNumber,
    port: PathBuf,
    number: [u8; 12],
}

impl Identities {
    /// Adds the board of finger 1, 2 or 3.
    ///
    /// # Errors
    /// Returns an error if a board at another port has the same number. Fingers on one port may share a number.
    pub fn add(&mut self, finger: FingerNumber, port: &Path, identity: &Identity) -> Result<(), HandError> {
        let number = identity.unique_number;
        match self.0.iter().find(|known| known.number == number && known.port != port) {
            Some(known) => Err(HandError::SameNumber {
                fingers: [known.finger, finger],
                ports: [known.port.clone(), port.to_owned()],
                number: BoardNumber(number).to_string(),
            }),
            None => {
                self.0.push(KnownNumber { finger, port: port.to_owned(), number });
                Ok(())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::board::protocol::{Capabilities, FirmwareVersion, VERSION};

    /// The identity of a board. The identities from two calls differ only in the unique number.
    fn identity(number: u8) -> Identity {
        Identity {
            version: VERSION,
            addresses: 0b1110,
            board_kind: 0,
            unique_number: [number; 12],
            firmware: FirmwareVersion([1, 0, 0]),
            counts_per_revolution: 2000,
            gauge_bits: 12,
            torque_unit: 2000,
            torque_limit: 23_750,
            shortest_watchdog_ms: 2,
            capabilities: Capabilities::HOLD,
        }
    }

    #[test]
    fn each_port_has_its_own_number_and_its_fingers_may_share_it() {
        let mut identities = Identities::default();
        assert!(identities.add(FingerNumber::ONE, Path::new("/dev/left"), &identity(5)).is_ok());
        assert!(identities.add(FingerNumber::TWO, Path::new("/dev/left"), &identity(5)).is_ok());
        assert!(identities.add(FingerNumber::THREE, Path::new("/dev/right"), &identity(6)).is_ok());
        let error = identities
            .add(FingerNumber::THREE, Path::new("/dev/right"), &identity(5))
            .expect_err("fingers 1 and 2 have this number");
        assert!(
            matches!(error, HandError::SameNumber { fingers: [FingerNumber::ONE, FingerNumber::THREE], .. }),
            "{error}"
        );
    }
}
