//! Frame types, and the errors of a frame's content.

use thiserror::Error;

/// The type of a frame. It is the high half of the header. The top bit is clear in a request and set in an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
#[allow(missing_docs, reason = "each variant is the frame type of the same name")]
pub enum Kind {
    Hello = 0x1,
    Configure = 0x2,
    Command = 0x3,
    Stop = 0x4,
    TactileRequest = 0x6,
    Identity = 0x9,
    Configured = 0xA,
    Reply = 0xB,
    Stopped = 0xC,
    Refused = 0xD,
    TactileEvent = 0xE,
}

impl Kind {
    /// Every type in use. 0x0, 0x7, 0x8 and 0xF are free. 0x5 is free too, but its answer would have the type 0xD,
    /// which is the type of Refused.
    pub const ALL: [Kind; 11] = [
        Kind::Hello,
        Kind::Configure,
        Kind::Command,
        Kind::Stop,
        Kind::TactileRequest,
        Kind::Identity,
        Kind::Configured,
        Kind::Reply,
        Kind::Stopped,
        Kind::Refused,
        Kind::TactileEvent,
    ];

    /// Returns the type with this number, or `None` if the number is not in use.
    pub fn from_number(number: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|&kind| kind as u8 == number)
    }
}

/// Why a frame with a correct check cannot be read.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum Malformed {
    /// This version has no type with this number.
    #[error("unknown frame type {0:#x}")]
    UnknownKind(u8),
    /// The body has the wrong length for its type. The sender uses another version of the protocol, or another
    /// protocol.
    #[error("a {kind:?} body has {expected} bytes, not {found}")]
    Length {
        /// The frame's type.
        kind: Kind,
        /// Length of every body of this type, bytes.
        expected: usize,
        /// Length of this body, bytes.
        found: usize,
    },
    /// A field has a value without a meaning.
    #[error("the field at byte {offset} of a {kind:?} has a value without a meaning")]
    Value {
        /// The frame's type.
        kind: Kind,
        /// Offset of the field, counted from the header.
        offset: u8,
    },
}
