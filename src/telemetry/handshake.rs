//! What a reader and a hand say to each other when the reader attaches. Afterwards the hand sends one byte
//! after each batch of messages, so that the reader can wait for the next batch.

use super::message::Description;
use serde::{Deserialize, Serialize};

/// What a reader sends first. The number is the version of the format of memory and messages.
pub(super) const REQUEST: &[u8] = b"sun2xp telemetry 1";

/// What a hand sends for each batch.
pub(super) const BATCH: &[u8] = b"b";

/// Largest reply, bytes. A description has some 10 kB.
pub(super) const LARGEST_REPLY: usize = 128 * 1024;

/// The answer to a request.
#[derive(Debug, Deserialize, Serialize)]
pub(super) enum Reply {
    /// The reader is attached. The memory file comes with this message.
    Attached {
        description: Box<Description>,
        /// Number of words of the memory file.
        words: u64,
        /// Position of the first block for this reader.
        position: u64,
    },
    /// The reader is not attached, for this reason.
    Refused(String),
}
