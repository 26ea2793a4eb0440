//! What is exchanged with a hand: the view of the hand, and the outbox. An [`Exchange`] has no clock and no thread. Its
//! callers hold a lock.

mod checks;

use crate::change::Change;
use crate::error::{Loss, RemoteError};
use crate::outbox::Outbox;
use crate::view::View;
use sun2xp_remote_protocol::{Answer, FINGERS, Finger, HandName, State};

/// The view of a hand, and the outbox.
#[derive(Debug)]
pub struct Exchange {
    pub view: View,
    pub outbox: Outbox,
    hand: HandName,
    endpoint: String,
    /// The configured limit of the age of a position, ms.
    stale_ms: u32,
}

impl Exchange {
    pub fn new(hand: HandName, endpoint: String, stale_ms: u32) -> Self {
        Self { view: View::default(), outbox: Outbox::new(Loss::Never), hand, endpoint, stale_ms }
    }

    /// The name of the hand.
    pub fn name(&self) -> &HandName {
        &self.hand
    }

    /// Takes a State that was received at the time `now`, ns on the client's clock.
    pub fn take_state(&mut self, state: &State, now: u64) {
        let continued = self.view.take_state(state, now);
        self.outbox.received(state.time, state.owner, continued);
        if self.outbox.ownership().is_ok_and(|ownership| ownership.number == state.owner) {
            for record in &state.records {
                self.outbox.confirm(record.finger, record.command);
            }
        }
    }

    /// Takes the refusal of a Target.
    pub fn take_refusal(&mut self, answer: &Answer) {
        self.view.statistics.refused += 1;
        self.outbox.refused(answer);
    }

    /// Puts changes into the outbox. The caller has checked them. `stamp` is the time stamp of their Target, if it is
    /// to be the same for several hands.
    pub fn put(&mut self, changes: [Option<Change>; FINGERS], stamp: Option<u64>) {
        self.outbox.put(changes, stamp);
    }

    /// Converts the number of a finger.
    ///
    /// # Errors
    /// Returns an error if the number is not 1, 2 or 3, or if the hand does not have this finger.
    pub fn finger(&self, number: i32) -> Result<Finger, RemoteError> {
        let finger = Finger::new(number).ok_or(RemoteError::NoSuchFinger(number))?;
        let status = self.view.status();
        if status.is_some_and(|status| status.fingers[finger.index()].is_none()) {
            return Err(RemoteError::NotInHand { finger, hand: self.hand.clone() });
        }
        Ok(finger)
    }
}

#[cfg(test)]
mod tests;
