//! Set points of several fingers that take effect in the same period.

use super::{Mailbox, PlannersEnd, SentSetPoint, ServoEnd, last_path};
use crate::control::SetPoint;
use crate::finger::{Fault, GroupGate, Replaced, Validity};
use crate::model::configuration::FINGERS;
use crate::realtime::LockedMemory;
use std::sync::MutexGuard;

/// The set point of one finger of a group, before the group is sent. No other planner can change the finger's set point
/// meanwhile. Dropping this value changes nothing.
pub struct PreparedSetPoint<'a> {
    planners: MutexGuard<'a, PlannersEnd>,
    replaced: Replaced,
    valid: Validity,
    set_point: SetPoint,
}

impl Mailbox {
    /// Prepares the set point of one finger for a group: changes a copy of the last set point, as [`Mailbox::try_send`]
    /// does. `replaced` is the part that changes, and `valid` is the time for which the set point is valid. A caller
    /// that prepares several fingers must do this in the order of their numbers, so that two callers cannot wait for
    /// each other.
    ///
    /// # Errors
    /// Returns the fault if the finger is faulted. The inner result is the refusal of `change`.
    pub fn prepare<E>(
        &self,
        (replaced, valid): (Replaced, Validity),
        change: impl FnOnce(&mut SetPoint) -> Result<(), E>,
    ) -> Result<Result<PreparedSetPoint<'_>, E>, Fault> {
        let mut planners = self.planners.lock();
        planners.begin()?;
        let path = planners.path_kept_by(replaced);
        let mut set_point = planners.sent.set_point;
        let changed = last_path::change_along(path, &mut set_point, change);
        Ok(changed.map(|()| PreparedSetPoint { planners, replaced, valid, set_point }))
    }
}

impl PreparedSetPoint<'_> {
    /// Returns whether the finger has room for another group.
    pub fn has_room(&self) -> bool {
        self.planners.grouped.has_room()
    }
}

impl GroupGate {
    /// Sends the set points of a group. All of them take effect in the same period. Every finger must have room. The
    /// servos of the fingers must have this gate.
    pub fn send(&self, mut group: [Option<PreparedSetPoint<'_>>; FINGERS]) {
        let number = self.number();
        for PreparedSetPoint { planners, replaced, valid, set_point } in group.iter_mut().flatten() {
            let mut sent = SentSetPoint { group: number, set_point: *set_point, ..planners.sent };
            sent.replace(*replaced, *valid);
            // The push succeeds: the finger had room, and since then only its servo can have changed the queue. The
            // servo only makes more room.
            if planners.grouped.push(sent).is_ok() {
                planners.sent = sent;
            }
        }
        self.post(number);
    }
}

impl ServoEnd {
    /// Replaces the gate, before the first cycle. Adds its pages to `memory`.
    pub fn set_gate(&mut self, gate: GroupGate, memory: &mut LockedMemory) {
        gate.add_to(memory);
        self.gate = gate;
    }

    /// Discards all groups that wait. The servo does this when the finger recovers, because the groups were sent in an
    /// earlier spring phase ([`FingerReport::springs`](crate::finger::FingerReport::springs)). A second reason is that
    /// the gate compares group numbers modulo 2^24. A group that still waited after some hours with many groups would
    /// seem not to be posted yet. It would then never take effect, and the later groups would wait for it.
    pub fn discard_groups(&mut self) {
        while let Some(discarded) = self.next_group.take().or_else(|| self.grouped.pop()) {
            self.in_effect = discarded.group;
        }
    }

    /// Returns the set point of the newest group that takes effect by `period`, the number of the period whose cycle
    /// runs; none if no group does. `now` returns the number of the period by the clock, which is later than `period`
    /// if the servo is late.
    pub fn new_group(&mut self, period: u64, now: impl Fn() -> u64) -> Option<SentSetPoint> {
        let mut newest = None;
        while let Some(next) = self.next_group.or_else(|| self.grouped.pop()) {
            if self.gate.period(next.group, &now).is_none_or(|from| from > period) {
                self.next_group = Some(next);
                break;
            }
            self.next_group = None;
            self.in_effect = next.group;
            newest = Some(next);
        }
        newest
    }
}
