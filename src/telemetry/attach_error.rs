//! Why a reader cannot attach to a hand.

use super::readers::MOST_READERS;
use crate::model::Shown;
use crate::realtime::with_remedy;
use std::io;
use thiserror::Error;

/// The reason why a reader cannot attach, with its remedy.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum AttachError {
    /// No hand is open.
    #[error(
        "no hand of this user is open: start the program that opens it, as the same user and in the same container, \
         with `telemetry.enabled = true` in its configuration"
    )]
    NoHand,
    /// No hand with this name is open.
    #[error("no hand of this user has the name \"{}\": {}", Shown(wanted), listed(open))]
    Unknown {
        /// The name.
        wanted: String,
        /// The names of the open hands.
        open: Vec<String>,
    },
    /// Several hands are open.
    #[error("several hands are open: name one of {} (the argument NAME, or the option --hand NAME)", .0.join(", "))]
    Several(Vec<String>),
    /// Another user's process has the name.
    #[error(
        "the socket of the hand \"{0}\" belongs to a process of another user: give your own hand another \
         `telemetry.name`, and use that name"
    )]
    Foreign(String),
    /// The hand's process does not answer.
    #[error(
        "the process of the hand \"{0}\" does not answer, because it is stopped or too busy to run its ordinary \
         threads: continue it (kill -CONT), or reduce the load of the machine"
    )]
    Silent(String),
    /// The hand refuses the reader.
    #[error("the hand \"{name}\" refuses this reader: {reason}")]
    Refused {
        /// The name.
        name: String,
        /// The reason.
        reason: String,
    },
    /// The hand was closed meanwhile, or already has the largest number of readers.
    #[error("the hand \"{0}\" was closed, or already has {MOST_READERS} readers: open it again, or end a reader")]
    Closed(String),
    /// The hand's answer cannot be understood.
    #[error(
        "the answer of the hand \"{name}\" cannot be understood ({reason}): use the sun2xp program of the same version \
         as the library of the hand"
    )]
    Incomprehensible {
        /// The name.
        name: String,
        /// What is wrong with the answer.
        reason: String,
    },
    /// The system's table of sockets, in which the open hands are found, cannot be read.
    #[error(
        "cannot read the names of the open hands: {0}. Mount /proc, and permit this process to read /proc/net/unix"
    )]
    Names(io::Error),
    /// The system refuses a call.
    #[error("cannot {doing}: {}", with_remedy(source))]
    System {
        /// What is not possible.
        doing: &'static str,
        /// The system's error.
        source: io::Error,
    },
}

fn listed(open: &[String]) -> String {
    match open {
        [] => "no hand is open. Start the program that opens it, as the same user and in the same container, with \
               `telemetry.enabled = true` in its configuration"
            .into(),
        names => format!("the open hands are {}", names.join(", ")),
    }
}
