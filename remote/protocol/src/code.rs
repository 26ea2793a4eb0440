//! The codes of Answers.

use crate::error::{FieldError, within};

/// The code of an Answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u16)]
pub enum Code {
    /// The request is done.
    Done = 0,
    /// The message was malformed.
    Malformed = 1,
    /// The message has another version of the protocol.
    OtherVersion = 2,
    /// The hand has no such finger.
    NoSuchFinger = 3,
    /// Another client owns the hand.
    Owned = 4,
    /// The sender is not the owner, or the epoch is old.
    NotOwner = 5,
    /// The hand refused an argument.
    Argument = 6,
    /// The hand refused the request, because a finger has stopped.
    Stopped = 7,
    /// The server ends, or cannot make an epoch.
    Closed = 8,
    /// A recovery or calibration is in progress already.
    InProgress = 9,
}

impl Code {
    /// All codes, in the order of their numbers.
    pub const ALL: [Code; 10] = [
        Self::Done,
        Self::Malformed,
        Self::OtherVersion,
        Self::NoSuchFinger,
        Self::Owned,
        Self::NotOwner,
        Self::Argument,
        Self::Stopped,
        Self::Closed,
        Self::InProgress,
    ];

    pub(crate) fn decode(number: u16) -> Result<Self, FieldError> {
        within("code", u64::from(number), 0, 9)?;
        Ok(Self::ALL[usize::from(number)])
    }
}
