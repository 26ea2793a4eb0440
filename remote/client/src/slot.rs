//! What is sent to one finger. A Target is the message with the set points of the owner. It is repeated, and contains
//! one part for each finger that it commands. A record is the server's report of one cycle of a finger.

use crate::change::Change;
use std::collections::VecDeque;
use sun2xp_remote_protocol::{Finger, Part, Place};

/// What is sent to one finger: the part that Targets repeat, and the changes that this part does not contain yet.
#[derive(Clone, Debug, Default)]
pub struct Slot {
    /// Changes that no Target contains yet.
    pending: Change,
    /// The command number and the values of the part that Targets repeat; none if the finger was not commanded, or if
    /// the newest part was refused.
    part: Option<(u32, Change)>,
    /// What was sent and is not confirmed, the oldest first.
    unconfirmed: VecDeque<Sent>,
}

/// A change that was sent.
#[derive(Clone, Debug)]
struct Sent {
    change: Change,
    command: u32,
    /// The sequence number of the first Target with this change.
    sequence: u64,
}

impl Slot {
    pub fn change(&mut self, change: Change) {
        self.pending.add(change);
    }

    /// Whether changes wait for a Target.
    pub fn waits(&self) -> bool {
        !self.pending.is_nothing()
    }

    /// Whether everything was sent, and records have confirmed all of it.
    pub fn is_applied(&self) -> bool {
        !self.waits() && self.unconfirmed.is_empty()
    }

    /// Whether the waiting changes must not be sent yet, because a path was sent and is not confirmed. If the path were
    /// repeated with the changes, it could begin twice. If it were left out, it could be lost.
    pub fn is_blocked(&self) -> bool {
        let path = matches!(&self.part, Some((_, values)) if matches!(values.place, Place::Path(_)));
        self.waits() && self.pending.place == Place::Kept && path && !self.unconfirmed.is_empty()
    }

    /// Makes a part with a new command number, for the Target with this sequence number. The part contains the waiting
    /// changes, and everything that no record has confirmed.
    pub fn renew(&mut self, command: u32, sequence: u64) {
        self.unconfirmed.push_back(Sent { change: std::mem::take(&mut self.pending), command, sequence });
        let mut values = Change::default();
        self.unconfirmed.iter().for_each(|sent| values.add(sent.change.clone()));
        self.part = Some((command, values));
    }

    /// The part of the next Target.
    pub fn part(&self, finger: Finger) -> Option<Part> {
        let (command, Change { place, stiffness, damping }) = self.part.clone()?;
        Some(Part { finger, command, place, stiffness, damping })
    }

    /// Notes that a record has shown this command number. Earlier changes that were not confirmed were in the same
    /// part, so they are confirmed too.
    pub fn confirm(&mut self, command: u32) {
        if let Some(place) = self.unconfirmed.iter().position(|sent| sent.command == command) {
            self.unconfirmed.drain(..=place);
        }
    }

    /// Drops the changes that were in the refused Target with this sequence number, and are not confirmed. Later
    /// changes are kept. If the first Target with a later change repeated the dropped changes, the server refuses that
    /// Target too, and this function then drops the later change.
    pub fn refuse(&mut self, sequence: u64) {
        let before = self.unconfirmed.len();
        self.unconfirmed.retain(|sent| sent.sequence > sequence);
        if self.unconfirmed.is_empty() && before > 0 {
            self.part = None;
        }
    }

    /// The sequence number of the first Target with a change that no record has confirmed.
    pub fn first_unconfirmed(&self) -> Option<u64> {
        self.unconfirmed.front().map(|sent| sent.sequence)
    }
}
