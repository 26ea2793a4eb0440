//! The types of messages.

use std::fmt;

/// The type of a message: its first byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum MessageKind {
    /// Set points of the owner.
    Target = 1,
    /// The cycles since the last State.
    State = 2,
    /// Something that happened to a finger.
    Event = 3,
    /// The status of a hand and of its server.
    Status = 4,
    /// A request of a client.
    Request = 5,
    /// The answer to a Request, or the refusal of a Target.
    Answer = 6,
}

impl fmt::Display for MessageKind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self, formatter)
    }
}
