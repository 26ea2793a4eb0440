//! Frame types, and what can be wrong with a frame of a type.

use thiserror::Error;

/// Frame types; the high half of the header. A request has the top bit clear, an answer has it set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
#[allow(missing_docs, reason = "each is the type of the same name")]
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
    /// Every type in use. 0x0, 0x7, 0x8 and 0xF are free; 0x5 as well, but its answer could only be a Refused.
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

    /// None where the number is free or kept.
    pub fn from_number(number: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|&kind| kind as u8 == number)
    }
}

/// Why a frame whose check holds cannot be read.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum Malformed {
    /// Nothing in this version has this number.
    #[error("unknown frame type {0:#x}")]
    UnknownKind(u8),
    /// Another version of the protocol, or not this protocol.
    #[error("a {kind:?} body has {expected} bytes, not {found}")]
    Length {
        /// The frame's type.
        kind: Kind,
        /// Bytes that its body has.
        expected: usize,
        /// Bytes found in its body.
        found: usize,
    },
    /// A field holds a number that means nothing.
    #[error("the field at byte {offset} of a {kind:?} has no such value")]
    Value {
        /// The frame's type.
        kind: Kind,
        /// Where the field begins, counted from the header.
        offset: u8,
    },
}
