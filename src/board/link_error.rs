//! What can be wrong with a board, in words for the person at the bench.

use super::port_error::PortError;
use super::protocol::{HIGHEST_ADDRESS, Kind, Reason, Refused, VERSION};
use super::terms::TermsError;
use thiserror::Error;

/// Why a board cannot be worked with. The texts name the cause and the remedy.
#[derive(Debug, Error)]
pub enum LinkError {
    /// The port itself.
    #[error(transparent)]
    Port(#[from] PortError),
    /// Not one byte came.
    #[error(
        "the board does not answer: not one byte came in {milliseconds} ms. Is it switched on, is the cable in, is this \
         its port, are transmit and receive crossed?"
    )]
    Silent {
        /// How long it was tried, ms.
        milliseconds: u64,
    },
    /// Bytes came, but no frame.
    #[error(
        "{bytes} bytes came, but no valid frame ({damaged} damaged): the baud rate differs from the board's, or what is \
         at this port is no board of this protocol"
    )]
    Unintelligible {
        /// Bytes that came.
        bytes: u64,
        /// Pieces that were no frame.
        damaged: u64,
    },
    /// Valid frames came, but not the one that was asked for.
    #[error("finger address {address} does not answer a {request:?} frame, though the board sends valid frames")]
    Unanswered {
        /// The finger.
        address: u8,
        /// The request.
        request: Kind,
    },
    /// The board has other fingers.
    #[error("the board at this port has no finger address {address}, but {}: configure finger.address", listed(*addresses))]
    WrongAddress {
        /// The address asked for.
        address: u8,
        /// Those it has, bit n for address n.
        addresses: u16,
    },
    /// No common protocol version.
    #[error(
        "the board speaks protocol versions {lowest} to {highest}, this library speaks {VERSION}: update the older of the \
         two"
    )]
    WrongVersion {
        /// The board's lowest.
        lowest: u8,
        /// The board's highest.
        highest: u8,
    },
    /// The board cannot keep what is configured.
    #[error("the board cannot keep what is configured: {0}")]
    Terms(#[from] TermsError),
    /// The board said no.
    #[error("finger address {address} refuses: {refused}")]
    Refused {
        /// The finger.
        address: u8,
        /// What it said.
        refused: Refused,
    },
    /// The board confirmed other terms than it was sent.
    #[error("finger address {address} confirms other terms than it was sent: its firmware is wrong")]
    OtherTerms {
        /// The finger.
        address: u8,
    },
}

impl LinkError {
    /// The nearest errno.
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

fn listed(addresses: u16) -> String {
    let names: Vec<String> = (1..=HIGHEST_ADDRESS)
        .filter(|address| addresses & 1 << address != 0)
        .map(|address| address.to_string())
        .collect();
    if names.is_empty() { "none".into() } else { names.join(", ") }
}
