//! The progress of a finger toward what was sent to it.

/// What a finger has done since the newest command of this client.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct RemoteProgress {
    /// The server has applied the command.
    pub applied: bool,
    /// The server has applied the command, and the finger has since arrived where the command wants it.
    pub arrived: bool,
    /// The joints have come to rest since the server applied the command.
    pub settled: bool,
}
