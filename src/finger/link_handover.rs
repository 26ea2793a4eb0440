//! The handover of a link between a servo and the thread that repairs its port. Opening a port and shaking hands take
//! too long for a servo. Each direction is a ring with one place, and neither side waits.

use crate::board::Link;
use crate::board::protocol::Configured;
use crate::model::configuration::FINGERS;
use crate::realtime::{Consumer, Producer, ring};

/// A link that no finger uses any more.
pub struct ReleasedLink<T> {
    /// The link.
    pub link: Link<T>,
    /// Whether the port of the link has failed. Such a link can only be closed.
    pub failed: bool,
}

/// A link whose boards have completed a new handshake.
pub struct RepairedLink<T> {
    /// The link.
    pub link: Link<T>,
    /// The confirmations of the boards, in the order of the fingers of the link.
    pub configured: [Option<Configured>; FINGERS],
    /// Number of emergency stops ([`stop_calls`](crate::finger::stop_calls)) when the repair was requested.
    pub stop_calls: u32,
}

/// The servo's end of the handover.
pub struct LinkServoEnd<T> {
    pub(super) released: Producer<ReleasedLink<T>>,
    pub(super) repaired: Consumer<RepairedLink<T>>,
}

/// The repairing thread's end of the handover.
pub struct LinkRepairEnd<T> {
    /// Links from the servo.
    pub released: Consumer<ReleasedLink<T>>,
    /// Links to the servo.
    pub repaired: Producer<RepairedLink<T>>,
}

/// Returns both ends of a new handover.
pub fn link_handover<T>() -> (LinkServoEnd<T>, LinkRepairEnd<T>) {
    let (released, released_out) = ring(1);
    let (repaired, repaired_out) = ring(1);
    (LinkServoEnd { released, repaired: repaired_out }, LinkRepairEnd { released: released_out, repaired })
}
