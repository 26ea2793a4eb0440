//! The errors of the client. Each text names the cause and the remedy.

mod kind;
mod loss;

pub use kind::RemoteErrorKind;
pub use loss::Loss;

use crate::admission::AdmissionError;
use std::path::PathBuf;
use sun2xp_remote_protocol::{Code, Finger, HandName, Stage};
use thiserror::Error;

/// A call that was refused or that failed. A refused call changes nothing.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RemoteError {
    /// The number of a finger is not 1, 2 or 3.
    #[error("there is no finger {0}: fingers are 1, 2 and 3")]
    NoSuchFinger(i32),
    /// The hand does not have this finger.
    #[error(
        "the hand \"{hand}\" has no finger {finger}: use a finger that it has, or add finger {finger} to \
         hand.fingers of the server"
    )]
    NotInHand {
        /// The finger.
        finger: Finger,
        /// The name of the hand.
        hand: HandName,
    },
    /// An argument that the finger cannot take.
    #[error(transparent)]
    Argument(#[from] AdmissionError),
    /// A hand is commanded twice in one call.
    #[error("the call has two groups for the hand \"{0}\": put their commands into one group")]
    TwiceTogether(HandName),
    /// The finger has stopped because of a fault.
    #[error(
        "finger {finger} is faulted (fault {fault}){}{name}. Remove the cause (docs/faults.md), and recover the finger",
        if name.is_empty() { "" } else { ": " }
    )]
    Faulted {
        /// The finger.
        finger: Finger,
        /// The number of the fault.
        fault: u16,
        /// The name of the fault, the affected part and the value of the fault. Empty if the newest Status does not
        /// describe this fault.
        name: String,
    },
    /// The finger does not act as a spring now.
    #[error("finger {finger} is {stage}: {}", until_running(stage))]
    Busy {
        /// The finger.
        finger: Finger,
        /// The name of its stage.
        stage: &'static str,
    },
    /// There is no connection to the hand.
    #[error("{0}")]
    NotConnected(String),
    /// The newest cycle that the client has received from the finger is too old.
    #[error(
        "the newest cycle of finger {finger} is {age_ms} ms old, and remote.stale_ms is {stale_ms}: check the line to \
         {endpoint} and the server, or raise remote.stale_ms"
    )]
    Stale {
        /// The finger.
        finger: Finger,
        /// The age of its newest cycle, ms.
        age_ms: u64,
        /// The configured limit, ms.
        stale_ms: u32,
        /// The configured endpoint.
        endpoint: String,
    },
    /// The client has received nothing from the hand for so long that it sends no set points.
    #[error(
        "for {age_ms} ms, nothing was received from the hand \"{hand}\", and remote.stale_ms is {stale_ms}, so no set \
         point is sent: check the line to {endpoint} and the server, and repeat this call when the hand answers again"
    )]
    Silent {
        /// The name of the hand.
        hand: HandName,
        /// The time since the newest State, ms.
        age_ms: u64,
        /// The configured limit, ms.
        stale_ms: u32,
        /// The configured endpoint.
        endpoint: String,
    },
    /// Another client owns the hand.
    #[error("{0}")]
    Owned(String),
    /// This client does not own the hand.
    #[error("this client does not own the hand \"{hand}\": {loss}")]
    NotOwner {
        /// The name of the hand.
        hand: HandName,
        /// The reason.
        loss: Loss,
    },
    /// The server has refused an earlier set point.
    #[error(
        "the hand has refused an earlier set point, and keeps the set point before it. If this call has a set point, \
         it was not sent: send it again. Reason of the refusal: {0}"
    )]
    Refused(String),
    /// The server has refused a request.
    #[error("{text}")]
    Answered {
        /// The code of the Answer.
        code: Code,
        /// The text of the Answer.
        text: String,
    },
    /// The server has sent data that is not a message of this version of the protocol.
    #[error(
        "the server of the hand \"{hand}\" has sent data that is not a message of version 1 of the protocol \
         ({reason}): use a client and a server of the same version"
    )]
    Protocol {
        /// The name of the hand.
        hand: HandName,
        /// What is wrong with the message.
        reason: String,
    },
    /// The table `[remote]` cannot be used.
    #[error("{}{}: {reason}", file.display(), line.map(|line| format!(":{line}")).unwrap_or_default())]
    Configuration {
        /// The file, or a description of the text.
        file: PathBuf,
        /// The line, from 1.
        line: Option<usize>,
        /// The cause and the remedy.
        reason: String,
    },
    /// The system has refused an operation.
    #[error("cannot {doing}: {source}{}", remedy(source))]
    System {
        /// The refused operation.
        doing: String,
        /// The error that the system reported.
        source: std::io::Error,
    },
}

/// Returns what lets a finger in this stage run again.
fn until_running(stage: &str) -> &'static str {
    if stage == Stage::Limp.name() {
        "zero or identify it"
    } else if stage == Stage::Closing.name() || stage == Stage::Closed.name() {
        "its server is shutting down. Start the server again, then open or reopen the hand"
    } else {
        "wait until it is running"
    }
}

/// Returns the remedy if the system has refused to start a thread, or if a file is missing or this user may not read
/// it. Every other error of the system already shows what to change, so the remedy is empty.
fn remedy(source: &std::io::Error) -> &'static str {
    match source.kind() {
        // EAGAIN: the start of a thread can cause this error, and the reading of a file cannot.
        std::io::ErrorKind::WouldBlock => ". Raise the limit of threads (ulimit -u)",
        std::io::ErrorKind::NotFound => ". Name an existing file",
        std::io::ErrorKind::PermissionDenied => ". This user needs permission to read the file and to enter its folder",
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::ErrorKind;

    #[test]
    fn a_refused_thread_and_an_unreadable_file_have_their_remedies() {
        let text = |kind: ErrorKind| RemoteError::System { doing: "do it".into(), source: kind.into() }.to_string();
        for (kind, remedy) in [
            (ErrorKind::WouldBlock, ". Raise the limit of threads (ulimit -u)"),
            (ErrorKind::NotFound, ". Name an existing file"),
            (ErrorKind::PermissionDenied, ". This user needs permission to read the file and to enter its folder"),
            (ErrorKind::InvalidData, "invalid data"),
        ] {
            let text = text(kind);
            assert!(text.starts_with("cannot do it: ") && text.ends_with(remedy), "{text}");
        }
    }
}
