//! The progress of a finger toward what was sent to it.

/// What a finger has done since the newest command of this client.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct RemoteProgress {
    /// The server has applied the command.
    pub applied: bool,
    /// Since then, the finger has arrived where the command wants it.
    pub arrived: bool,
    /// Since then, the joints have come to rest.
    pub settled: bool,
}
