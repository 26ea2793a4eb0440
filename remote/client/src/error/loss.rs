//! Why a client does not own a hand.

use std::fmt;

/// Why a client does not own a hand. The client never acquires the hand again by itself, because the hand would then
/// follow a planner that does not know what happened meanwhile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Loss {
    /// The client only watches.
    Never,
    /// The ownership has ended at the server.
    Ended,
    /// Another client has acquired the hand.
    TakenOver,
    /// The server was started again.
    Restarted,
    /// The client has released the hand.
    Released,
}

impl fmt::Display for Loss {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Never => "it only watches the hand. To command the hand, open it instead of watching it",
            Self::Ended => {
                "the server has ended the ownership of this client, because no Target (the message with the set \
                 points) arrived for the time `serve.end_ms`, or because the hand was released. Check the line, then \
                 open or reopen the hand"
            }
            Self::TakenOver => {
                "another client has acquired it. Open or reopen the hand when that client has released it"
            }
            Self::Restarted => "the server was started again. Open or reopen the hand",
            Self::Released => "it has released the hand. Open or reopen the hand",
        })
    }
}
