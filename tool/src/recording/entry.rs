//! The contents of a recording.

use sun2xp::model::FingerNumber;
use sun2xp::telemetry::Message;

/// One item of a recording.
#[derive(Clone, Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "most values are of the large variant, and a box would cost an allocation for each"
)]
pub enum Item {
    /// A message of telemetry. In a status, `last` (the last cycle) is `None`.
    Message(Message),
    /// Cycles of this finger are missing here, because the recorder or the hand was too slow.
    Lost {
        /// The finger.
        finger: FingerNumber,
        /// Number of cycles.
        cycles: u64,
    },
}

/// An item with its time, ns since 1970.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The time.
    pub time: u64,
    /// The item.
    pub item: Item,
}
