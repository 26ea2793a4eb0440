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
    /// The sender is not the owner, its epoch is old, or it may not send this Request.
    NotOwner = 5,
    /// The hand refused an argument, or a recovery or calibration failed.
    Argument = 6,
    /// The hand refused the request, because a finger has stopped.
    Stopped = 7,
    /// The server is shutting down, or its machine has no random numbers for an epoch.
    Closed = 8,
    /// A recovery or calibration is already in progress. For a Target also: a finger is being opened or closed, or is
    /// limp.
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
