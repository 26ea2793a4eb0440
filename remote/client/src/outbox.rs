//! The outbox of an owner: decides what the next Target is, and when it must be sent. It has no clock and no thread.

use crate::change::Change;
use crate::error::Loss;
use crate::slot::Slot;
use sun2xp_remote_protocol::{Answer, FINGERS, Finger, LONGEST_VALIDITY_MS, Target};

/// Interval at which a Target is repeated, ns. The protocol demands at most 25 ms.
pub const REPETITION: u64 = 20_000_000;

/// Smallest interval of two Targets, ns. It is below the period of a servo at 1000 Hz. It limits the number of
/// Targets if a planner sends without a pause.
const LEAST_INTERVAL: u64 = 500_000;

/// If a State is earlier than an Answer by more than this, ns, the server's machine was started again. A State cannot
/// be on its way for so long.
const RESTARTED: u64 = 10_000_000_000;

/// The ownership of the hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ownership {
    pub epoch: u64,
    /// The public number of the epoch. (`epoch` itself is random, and a secret of the owner.)
    pub number: u64,
    /// The time of the Answer that gave the epoch, ns, server's clock.
    since: u64,
    catch_ms: u32,
}

/// What the owner sends.
#[derive(Debug)]
pub struct Outbox {
    ownership: Result<Ownership, Loss>,
    slots: [Slot; FINGERS],
    /// The newest command number.
    command: u32,
    /// The sequence number of the newest Target.
    sequence: u64,
    /// The newest time of a State or Answer, server's clock.
    seen: u64,
    /// The time stamp that the next Target with changes shares with Targets to other hands; none if it shares none.
    stamp: Option<u64>,
    /// The time of the newest Target of this epoch, and its time stamp.
    sent: Option<(u64, u64)>,
    /// The text of a refusal that no call has reported.
    refusal: Option<String>,
    /// Refusals of Targets up to this sequence number are not reported any more.
    reported: u64,
    /// Whether the Targets of this epoch are held back.
    held: bool,
}

impl Outbox {
    pub fn new(loss: Loss) -> Self {
        Self {
            ownership: Err(loss),
            slots: Default::default(),
            command: 0,
            sequence: 0,
            seen: 0,
            stamp: None,
            sent: None,
            refusal: None,
            reported: 0,
            held: false,
        }
    }

    pub fn ownership(&self) -> Result<Ownership, Loss> {
        self.ownership
    }

    /// Begins a new epoch. Nothing of an earlier one is sent again.
    pub fn acquired(&mut self, answer: &Answer) {
        let &Answer { epoch, number, time, catch_ms, .. } = answer;
        *self = Self {
            ownership: Ok(Ownership { epoch, number, since: time, catch_ms }),
            command: self.command,
            seen: time,
            ..Self::new(Loss::Never)
        };
    }

    /// Ends the epoch. What was not sent is discarded.
    pub fn lose(&mut self, loss: Loss) {
        if self.ownership.is_ok() {
            *self = Self { command: self.command, ..Self::new(loss) };
        }
    }

    /// If `held` is true, holds back the Targets of this epoch until a call with `held` false. Changes that are put in
    /// the meantime wait.
    pub fn hold(&mut self, held: bool) {
        self.held = held;
    }

    /// Notes the time and the owner of a State that was received. `continued` is false if the server was started again
    /// since the previous State.
    pub fn received(&mut self, time: u64, owner: u64, continued: bool) {
        if let Ok(Ownership { number, since, .. }) = self.ownership {
            // A State that is not later than the Answer may show an earlier owner. It may also have been sent between a
            // restart of the server and the Answer. `continued` is then false, although this epoch, which began after
            // the restart, has not ended.
            let lost = if time > since { owner != number } else { since - time > RESTARTED };
            match (lost, continued) {
                (false, _) => {}
                (true, false) => self.lose(Loss::Restarted),
                (true, true) => self.lose(if owner == 0 { Loss::Ended } else { Loss::TakenOver }),
            }
        }
        self.seen = self.seen.max(time);
    }

    /// Notes that a record in a State of this epoch has shown the command number.
    pub fn confirm(&mut self, finger: Finger, command: u32) {
        self.slots[finger.index()].confirm(command);
    }

    /// Whether every change for this finger was sent, and records have confirmed all of them.
    pub fn is_applied(&self, finger: Finger) -> bool {
        self.slots[finger.index()].is_applied()
    }

    /// Notes that the server has refused a Target. The next change for a finger is sent without the values of this
    /// Target that no record has confirmed.
    pub fn refused(&mut self, answer: &Answer) {
        self.seen = self.seen.max(answer.time);
        if self.ownership.is_ok_and(|ownership| ownership.epoch == answer.epoch) {
            self.slots.iter_mut().for_each(|slot| slot.refuse(answer.number));
            if answer.number > self.reported {
                self.refusal = Some(answer.text.clone());
                // The server also refuses the later Targets that repeat the refused values. Of these refusals, only
                // those are reported whose Target also contained a later change that the slots have kept.
                let others = self.slots.iter().filter_map(Slot::first_unconfirmed).min();
                self.reported = others.map_or(self.sequence, |first| first - 1).max(answer.number);
            }
        }
    }

    /// Takes the text of the newest refusal that no call has reported.
    pub fn take_refusal(&mut self) -> Option<String> {
        self.refusal.take()
    }

    /// Puts changes into the outbox. All of them take effect in the same cycle. `stamp` is the time stamp of their
    /// Target, if it is to be the same for several hands.
    pub fn put(&mut self, changes: [Option<Change>; FINGERS], stamp: Option<u64>) {
        for (slot, change) in self.slots.iter_mut().zip(changes) {
            if let Some(change) = change {
                slot.change(change);
            }
        }
        self.stamp = stamp.or(self.stamp);
    }

    /// Whether changes wait and may be sent. If the changes for one finger must wait, those for the other fingers wait
    /// too, because they may belong to one group.
    fn has_changes(&self) -> bool {
        self.slots.iter().any(Slot::waits) && !self.slots.iter().any(Slot::is_blocked)
    }

    /// The time at which the next Target must be sent; none while the hand is not owned or Targets are held back.
    pub fn due(&self) -> Option<u64> {
        self.ownership.ok().filter(|_| !self.held)?;
        let interval = if self.has_changes() { LEAST_INTERVAL } else { REPETITION };
        Some(self.sent.map_or(0, |(sent, _)| sent + interval))
    }

    /// Returns the next Target if it must be sent now.
    pub fn next(&mut self, now: u64) -> Option<Target> {
        let Ownership { epoch, catch_ms, .. } = self.ownership.ok()?;
        if self.due()? > now {
            return None;
        }
        let mut stamp = now;
        if self.has_changes() {
            stamp = self.stamp.take().unwrap_or(now);
            for slot in self.slots.iter_mut().filter(|slot| slot.waits()) {
                self.command = self.command.checked_add(1).unwrap_or(1);
                slot.renew(self.command, self.sequence + 1);
            }
        }
        // The time stamps of Targets must never decrease.
        let stamp = stamp.max(self.sent.map_or(0, |(_, before)| before));
        self.sequence += 1;
        self.sent = Some((now, stamp));
        let sequence = self.sequence;
        let parts = Finger::ALL.iter().zip(&self.slots).filter_map(|(&finger, slot)| slot.part(finger));
        let parts = parts.collect();
        let validity_ms = catch_ms.clamp(1, LONGEST_VALIDITY_MS);
        Some(Target { validity_ms, epoch, sequence, sent: stamp, seen: self.seen, parts })
    }
}

#[cfg(test)]
mod tests;
