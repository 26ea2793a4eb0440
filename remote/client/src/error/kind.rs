//! The kinds of errors, for callers that map them to numbers.

use super::RemoteError;
use crate::admission::AdmissionError;
use sun2xp_remote_protocol::Code;

/// The kind of a [`RemoteError`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum RemoteErrorKind {
    /// No finger has this number.
    NoSuchFinger,
    /// The hand does not have the finger.
    NotInHand,
    /// An argument is wrong.
    Argument,
    /// An argument is outside a limit.
    OutOfRange,
    /// A Kx is not symmetric or has a negative eigenvalue, so it does not describe a spring.
    NotASpring,
    /// The finger has stopped.
    Faulted,
    /// The finger is busy.
    Busy,
    /// There is no connection to the hand, or nothing was received from it for too long.
    NotConnected,
    /// What is known of the finger is too old.
    Stale,
    /// Another client owns the hand.
    Owned,
    /// This client does not own the hand, or no longer owns it.
    NotOwner,
    /// The hand has refused an earlier set point, or a request.
    Refused,
    /// The server is shutting down, or has no random number for an epoch, the secret of a new owner of the hand.
    Closed,
    /// The server has sent data that is not a message of this version of the protocol, or has answered that a request
    /// is malformed or has another version.
    Protocol,
    /// The configuration cannot be used.
    Configuration,
    /// The system has refused an operation.
    System,
}

impl RemoteError {
    /// The kind of this error.
    #[must_use]
    pub fn kind(&self) -> RemoteErrorKind {
        match self {
            Self::NoSuchFinger(_) => RemoteErrorKind::NoSuchFinger,
            Self::NotInHand { .. } => RemoteErrorKind::NotInHand,
            Self::Argument(error) => of_argument(error),
            Self::TwiceTogether(_) => RemoteErrorKind::Argument,
            Self::Faulted { .. } => RemoteErrorKind::Faulted,
            Self::Busy { .. } => RemoteErrorKind::Busy,
            Self::NotConnected(_) | Self::Silent { .. } => RemoteErrorKind::NotConnected,
            Self::Stale { .. } => RemoteErrorKind::Stale,
            Self::Owned(_) => RemoteErrorKind::Owned,
            Self::NotOwner { .. } => RemoteErrorKind::NotOwner,
            Self::Refused(_) => RemoteErrorKind::Refused,
            Self::Answered { code, .. } => of_code(*code),
            Self::Protocol { .. } => RemoteErrorKind::Protocol,
            Self::Configuration { .. } => RemoteErrorKind::Configuration,
            Self::System { .. } => RemoteErrorKind::System,
        }
    }

    /// The finger that the error names; none if it names no finger.
    #[must_use]
    pub fn finger(&self) -> Option<i32> {
        let finger = match self {
            Self::NoSuchFinger(number) => return Some(*number),
            Self::NotInHand { finger, .. }
            | Self::Faulted { finger, .. }
            | Self::Busy { finger, .. }
            | Self::Stale { finger, .. } => finger,
            Self::Argument(error) => return error.finger().map(|finger| i32::from(finger.number())),
            _ => return None,
        };
        Some(i32::from(finger.number()))
    }

    /// The number of the fault that has stopped the finger; 0 if the error does not contain this number.
    #[must_use]
    pub fn fault(&self) -> u16 {
        match self {
            Self::Faulted { fault, .. } => *fault,
            _ => 0,
        }
    }
}

fn of_argument(error: &AdmissionError) -> RemoteErrorKind {
    match error {
        AdmissionError::BeyondJointLimit { .. } | AdmissionError::TooStiff { .. } | AdmissionError::Damping { .. } => {
            RemoteErrorKind::OutOfRange
        }
        AdmissionError::NotSymmetric { .. } | AdmissionError::Negative { .. } => RemoteErrorKind::NotASpring,
        AdmissionError::NotFinite { .. }
        | AdmissionError::TwiceInGroup(_)
        | AdmissionError::Count { .. }
        | AdmissionError::Time { .. } => RemoteErrorKind::Argument,
    }
}

fn of_code(code: Code) -> RemoteErrorKind {
    match code {
        Code::Done | Code::Malformed | Code::OtherVersion => RemoteErrorKind::Protocol,
        Code::NoSuchFinger => RemoteErrorKind::NotInHand,
        Code::Owned => RemoteErrorKind::Owned,
        Code::NotOwner => RemoteErrorKind::NotOwner,
        Code::Argument => RemoteErrorKind::Refused,
        Code::Stopped => RemoteErrorKind::Faulted,
        Code::Closed => RemoteErrorKind::Closed,
        Code::InProgress => RemoteErrorKind::Busy,
    }
}
