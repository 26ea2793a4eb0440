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
    /// Whether its port has failed, so the link can only be closed.
    pub failed: bool,
}

/// A link whose boards have completed a new handshake.
pub struct RepairedLink<T> {
    /// The link.
    pub link: Link<T>,
    /// What the board of each finger of the link has confirmed, in their order.
    pub configured: [Option<Configured>; FINGERS],
    /// Number of emergency stops ([`stop_calls`](crate::finger::stop_calls)) when the repair was requested.
    pub stop_calls: u32,
}

/// The servo's end.
pub struct LinkServoEnd<T> {
    pub(super) released: Producer<ReleasedLink<T>>,
    pub(super) repaired: Consumer<RepairedLink<T>>,
}

/// The repairing thread's end.
pub struct LinkRepairEnd<T> {
    /// Links from the servo.
    pub released: Consumer<ReleasedLink<T>>,
    /// Links to the servo.
    pub repaired: Producer<RepairedLink<T>>,
}

/// Returns both ends.
pub fn link_handover<T>() -> (LinkServoEnd<T>, LinkRepairEnd<T>) {
    let (released, released_out) = ring(1);
    let (repaired, repaired_out) = ring(1);
    (LinkServoEnd { released, repaired: repaired_out }, LinkRepairEnd { released: released_out, repaired })
}
