//! The handover of a link between a servo and the thread that repairs its port. Opening a port and shaking hands take
//! too long for a servo. The links pass through rings, and neither side waits.
//!
//! While other fingers of the port run, the servo keeps the link. The repairing thread then shakes hands with the board
//! of one finger over the [`Relay`].

use crate::board::Link;
use crate::board::protocol::Configured;
use crate::finger::StopCounts;
use crate::finger::relay::{Relay, RelayServoEnd, relay};
use crate::model::configuration::FINGERS;
use crate::realtime::{Consumer, LockedMemory, Producer, ring};

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
    /// The boards, in the order of the fingers of the link.
    pub boards: [Option<RestoredBoard>; FINGERS],
}

/// A board that has completed a new handshake.
#[derive(Clone, Copy, Debug)]
pub struct RestoredBoard {
    /// The confirmation of the board.
    pub configured: Configured,
    /// How many requests to stop and how many faults there had been before the recovery began.
    pub stops: StopCounts,
    /// Number of restarts of the board that recoveries have detected since open. A recovery looks for a restart only if
    /// the board loses its zeros or the readings of tactile elements at a restart. For other boards the number is 0.
    pub restarts: u32,
}

/// One finger of a link that the servo has kept. Its board has completed a new handshake over the relay.
#[derive(Clone, Copy, Debug)]
pub struct RestoredFinger {
    /// The address of the finger on the port.
    pub address: u8,
    /// The board.
    pub board: RestoredBoard,
}

/// The servo's end of the handover.
pub struct LinkServoEnd<T> {
    pub(super) released: Producer<ReleasedLink<T>>,
    pub(super) repaired: Consumer<RepairedLink<T>>,
    pub(super) restored: Consumer<RestoredFinger>,
    pub(super) relay: RelayServoEnd,
}

impl<T> LinkServoEnd<T> {
    /// Adds to `memory` the pages that both ends share.
    pub(super) fn add_to(&self, memory: &mut LockedMemory) {
        self.released.add_to(memory);
        self.repaired.add_to(memory);
        self.restored.add_to(memory);
        self.relay.add_to(memory);
    }
}

/// The repairing thread's end of the handover.
pub struct LinkRepairEnd<T> {
    /// Links from the servo.
    pub released: Consumer<ReleasedLink<T>>,
    /// Links to the servo.
    pub repaired: Producer<RepairedLink<T>>,
    /// Fingers for the servo that has kept the link.
    pub restored: Producer<RestoredFinger>,
    /// Passes requests to the boards of a link that the servo has kept.
    pub relay: Link<Relay>,
}

/// Returns both ends of a new handover.
pub fn link_handover<T>() -> (LinkServoEnd<T>, LinkRepairEnd<T>) {
    let (released, released_out) = ring(1);
    let (repaired, repaired_out) = ring(1);
    let (restored, restored_out) = ring(1);
    let (relay, relay_out) = relay();
    (
        LinkServoEnd { released, repaired: repaired_out, restored: restored_out, relay: relay_out },
        LinkRepairEnd { released: released_out, repaired, restored, relay: Link::new(relay) },
    )
}
