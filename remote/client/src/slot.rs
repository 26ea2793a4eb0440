//! What is sent to one finger.

use crate::change::Change;
use sun2xp_remote_protocol::{Finger, Part, Place};

/// What is sent to one finger: the part that Targets contain, and the changes that are not in this part yet.
#[derive(Clone, Debug, Default)]
pub struct Slot {
    /// Changes that no Target has yet.
    pending: Change,
    /// The part that Targets repeat; none if the finger was not commanded.
    part: Option<Repeated>,
}

#[derive(Clone, Debug)]
struct Repeated {
    command: u32,
    values: Change,
    /// The first Target with this part; 0 if there is none yet.
    sequence: u64,
    /// Whether a record has shown its command number.
    confirmed: bool,
}

impl Slot {
    pub fn change(&mut self, change: Change) {
        self.pending.add(change);
    }

    /// Whether changes wait for a Target.
    pub fn waits(&self) -> bool {
        !self.pending.is_nothing()
    }

    /// Whether a record has shown everything that was sent.
    pub fn is_applied(&self) -> bool {
        !self.waits() && self.part.as_ref().is_none_or(|part| part.confirmed)
    }

    /// Whether the waiting changes must not be sent yet, because a path was sent and is not confirmed. If the path were
    /// repeated with the changes, it could begin twice. If it were left out, it could be lost.
    pub fn is_blocked(&self) -> bool {
        let unconfirmed_path =
            |part: &Repeated| !part.confirmed && part.sequence != 0 && matches!(part.values.place, Place::Path(_));
        self.waits() && self.pending.place == Place::Kept && self.part.as_ref().is_some_and(unconfirmed_path)
    }

    /// Makes a part with a new command number. It contains the waiting changes, and everything that no record has
    /// confirmed.
    pub fn renew(&mut self, command: u32) {
        let mut values = match self.part.take() {
            Some(part) if !part.confirmed => part.values,
            _ => Change::default(),
        };
        values.add(std::mem::take(&mut self.pending));
        self.part = Some(Repeated { command, values, sequence: 0, confirmed: false });
    }

    /// The part of the Target with this sequence number.
    pub fn part(&mut self, finger: Finger, sequence: u64) -> Option<Part> {
        let part = self.part.as_mut()?;
        if part.sequence == 0 {
            part.sequence = sequence;
        }
        let Change { place, stiffness, damping } = part.values.clone();
        Some(Part { finger, command: part.command, place, stiffness, damping })
    }

    /// Notes that a record has shown this command number.
    pub fn confirm(&mut self, command: u32) {
        if let Some(part) = self.part.as_mut().filter(|part| part.command == command) {
            part.confirmed = true;
        }
    }

    /// Drops the part if it was in the refused Target with this sequence number, and is not confirmed.
    pub fn refuse(&mut self, sequence: u64) {
        self.part.take_if(|part| !part.confirmed && part.sequence != 0 && part.sequence <= sequence);
    }

    /// The first Target with a part that no record has confirmed.
    pub fn first_unconfirmed(&self) -> Option<u64> {
        self.part.as_ref().filter(|part| !part.confirmed && part.sequence != 0).map(|part| part.sequence)
    }
}
