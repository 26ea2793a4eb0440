//! The errors of a board, as text for the person at the bench.

use super::port_error::PortError;
use super::protocol::{ANY_ADDRESS, HIGHEST_ADDRESS, Kind, Reason, Refused, VERSION};
use super::terms::TermsError;
use crate::model::Counted;
use thiserror::Error;

/// Why the host cannot work with a board. The texts name the cause and the remedy.
#[derive(Debug, Error)]
pub enum LinkError {
    /// The port failed.
    #[error(transparent)]
    Port(#[from] PortError),
    /// No byte was received.
    #[error(
        "the board does not answer: no byte was received in {milliseconds} ms. Check that it is switched on, that its \
         cable is plugged in, that finger.port is its port, and that the transmit output of each side is connected to \
         the receive input of the other"
    )]
    Silent {
        /// How long the host tried, ms.
        milliseconds: u64,
    },
    /// Bytes were received, but no valid frame.
    #[error(
        "{} received, but no valid frame ({damaged} damaged): finger.baud differs from the baud rate \
         of the board, or the device at this port uses another protocol. Check finger.baud and finger.port",
        Counted(*bytes, "byte was", "bytes were")
    )]
    Unintelligible {
        /// Bytes received.
        bytes: u64,
        /// Pieces that were not valid frames.
        damaged: u64,
    },
    /// Valid frames were received, but not the answer to the request.
    #[error(
        "{} a {request:?} frame, although the board sends valid frames: its firmware is faulty, or several boards \
         share the port. Update the firmware, and connect only one board to a port",
        match *address {
            ANY_ADDRESS => "no finger answers".to_string(),
            address => format!("finger address {address} does not answer"),
        }
    )]
    Unanswered {
        /// The finger's address, or [`ANY_ADDRESS`] if the request was for any finger of the board.
        address: u8,
        /// The request.
        request: Kind,
    },
    /// The board has no finger with this address.
    #[error(
        "the board at this port has no finger address {address}; it has {}, or check finger.port",
        present(*addresses)
    )]
    WrongAddress {
        /// The requested address.
        address: u8,
        /// The addresses of the board, bit n for address n.
        addresses: u16,
    },
    /// Board and library have no common protocol version.
    #[error(
        "the board supports protocol versions {lowest} to {highest}, and this library supports version {VERSION}: \
         update the older of the two"
    )]
    WrongVersion {
        /// The board's lowest version.
        lowest: u8,
        /// The board's highest version.
        highest: u8,
    },
    /// The board cannot meet the configuration.
    #[error("the board cannot do what is configured: {0}")]
    Terms(#[from] TermsError),
    /// The board refused a request.
    #[error("the board refuses the request (finger address {address}): {refused}")]
    Refused {
        /// The finger's address.
        address: u8,
        /// The refusal.
        refused: Refused,
    },
    /// The board confirmed terms that differ from the terms that the host sent.
    #[error(
        "the board does not confirm the configuration that the host sent for finger address {address}, but a \
         different one: update its faulty firmware"
    )]
    OtherTerms {
        /// The finger's address.
        address: u8,
    },
}

impl LinkError {
    /// Returns the cause and the remedy in few words, for a list of ports at which no board was found.
    pub fn in_short(&self) -> String {
        match self {
            LinkError::Port(error) => error.in_short(),
            LinkError::Silent { .. } => "nothing answers: check power and cable".into(),
            LinkError::Unintelligible { .. } => {
                "no valid frame: check the bit rate, and that the device is a board".into()
            }
            LinkError::WrongVersion { lowest, highest } => {
                format!("the board has protocol {lowest} to {highest}, the library {VERSION}: update the older one")
            }
            // A search for boards sends only Hello, which every board must answer. Only faulty firmware, or several
            // boards at the port, can therefore cause the other errors.
            _ => "faulty firmware, or several boards: update firmware, or connect only one board".into(),
        }
    }

    /// Returns the closest errno.
    pub fn errno(&self) -> i32 {
        match self {
            LinkError::Port(error) => error.errno(),
            LinkError::Silent { .. } | LinkError::Unanswered { .. } => libc::ETIMEDOUT,
            LinkError::Unintelligible { .. } | LinkError::OtherTerms { .. } => libc::EPROTO,
            LinkError::WrongAddress { .. } => libc::ENXIO,
            LinkError::WrongVersion { .. } => libc::EPROTONOSUPPORT,
            LinkError::Terms(_) => libc::EINVAL,
            LinkError::Refused { refused, .. } => match refused.reason {
                Reason::Running => libc::EBUSY,
                _ => libc::EIO,
            },
        }
    }
}

/// Lists the addresses that the board has, followed by the first part of the remedy.
fn present(addresses: u16) -> String {
    let names: Vec<String> = (1..=HIGHEST_ADDRESS)
        .filter(|address| addresses & 1 << address != 0)
        .map(|address| address.to_string())
        .collect();
    match names.is_empty() {
        true => "none at all: update its faulty firmware".into(),
        false => format!("{}: set finger.address to one that it has", names.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io;
    use std::path::PathBuf;

    #[test]
    fn every_port_without_a_board_has_its_cause_and_a_remedy_in_short() {
        let path = || PathBuf::from("/dev/ttyUSB0");
        let broken = || io::Error::from_raw_os_error(libc::EPROTO);
        let errors: [(LinkError, &str); 13] = [
            (PortError::Missing(path()).into(), "does not exist"),
            (PortError::Forbidden(path()).into(), "no permission"),
            (PortError::Busy(path()).into(), "in use by another program"),
            (PortError::NotReady(path()).into(), "not ready"),
            (PortError::NotASerialPort(path()).into(), "not a serial port"),
            (PortError::Baud { path: path(), wanted: 2_000_000, offered: 9600 }.into(), "cannot run at 2000000 bit/s"),
            (PortError::Opening { path: path(), source: broken() }.into(), "Protocol error"),
            (PortError::Vanished.into(), "disappeared"),
            (PortError::Closed.into(), "this program has closed its descriptor"),
            (LinkError::Silent { milliseconds: 160 }, "nothing answers"),
            (LinkError::Unintelligible { bytes: 9, damaged: 1 }, "no valid frame"),
            (LinkError::WrongVersion { lowest: 2, highest: 3 }, "the board has protocol 2 to 3"),
            (LinkError::Unanswered { address: 1, request: Kind::Hello }, "faulty firmware"),
        ];
        for (error, cause) in errors {
            let text = error.in_short();
            let (before, remedy) = text.split_once(": ").expect("a remedy");
            assert!(before.starts_with(cause) && !remedy.is_empty() && text.len() <= 80, "{text}");
        }
    }

    #[test]
    fn a_board_without_the_address_has_a_remedy_that_is_possible() {
        let text = |addresses| LinkError::WrongAddress { address: 1, addresses }.to_string();
        assert!(text(0b1100).contains("it has 2, 3: set finger.address to one that it has, or check finger.port"));
        assert!(text(0).contains("it has none at all: update its faulty firmware, or check finger.port"));
    }
}
