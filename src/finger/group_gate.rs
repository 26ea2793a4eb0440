//! The gate of a hand: lets the set points of a group take effect in the same period in every servo thread.
//!
//! A planner first gives each finger of the group its set point, and then posts the group. The first servo that sees
//! the posted group decides the period of the group. If the planner chose the period instead, and were preempted before
//! it had sent every set point, some servos would begin that period without their set points.

use crate::realtime::atomics::{AtomicU64, Ordering};
use crate::realtime::{LockedMemory, Pages, SharedPages};

/// Number of groups whose state the gate remembers. It is larger than the number of groups that can wait in a finger.
const REMEMBERED: usize = 64;

/// Number of low bits of a state. They hold the number of the group's period plus 1, or [`POSTED`].
const PERIOD_BITS: u32 = 40;

/// The group is posted, and no servo has decided its period yet.
const POSTED: u64 = 0;

/// The gate of a hand. Clones share its state.
#[derive(Clone)]
pub struct GroupGate(SharedPages<Shared>);

struct Shared {
    /// Number of the newest group. The first group has the number 1.
    newest: AtomicU64,
    /// The state of group g is at index g modulo [`REMEMBERED`]. Its bits above the lowest [`PERIOD_BITS`] hold the low
    /// bits of g, so that a servo recognises the state of another group.
    states: [AtomicU64; REMEMBERED],
}

impl Default for GroupGate {
    fn default() -> Self {
        Self::new()
    }
}

impl GroupGate {
    /// Creates the gate of a hand. No group has been sent yet.
    pub fn new() -> Self {
        let states = [(); REMEMBERED].map(|()| AtomicU64::new(0));
        Self(Pages::new(Shared { newest: AtomicU64::new(0), states }).into())
    }

    /// Returns the number of a new group.
    pub(super) fn number(&self) -> u64 {
        self.0.newest.fetch_add(1, Ordering::Relaxed) + 1
    }

    /// Posts a group. Every finger of the group must have its set point already.
    pub(super) fn post(&self, group: u64) {
        self.state(group).store(tag(group) | POSTED, Ordering::Release);
    }

    /// Returns the number of the first period in which a group is in effect; none if it is not posted yet; 0 if the
    /// gate no longer remembers the group. If no servo has decided this number, it is the period after the present one.
    /// `now` returns the number of the present period.
    ///
    /// The result is the same for every servo, and no servo has begun that period before the group was posted:
    /// - A servo calls `now` after it has seen the posted group. If another servo begins a cycle without seeing the
    ///   group, that cycle is in the present period or an earlier one.
    /// - A servo that sees the posted group cannot leave the period undecided. If the first servo is preempted before
    ///   it decides, the next servo that sees the group decides. So the period is decided before any servo that has
    ///   seen the group begins a later cycle.
    pub(super) fn period(&self, group: u64, now: impl FnOnce() -> u64) -> Option<u64> {
        let state = self.state(group).load(Ordering::Acquire);
        // The difference of the tags, as a signed number.
        match (state & !PERIOD_MASK).wrapping_sub(tag(group)).cast_signed() {
            ..0 => return None,
            0 => {}
            // The finger did not run while many other groups were sent. The group has taken effect elsewhere.
            _ => return Some(0),
        }
        if let Some(period) = decided(state) {
            return Some(period);
        }
        let period = now() + 1;
        let decision = tag(group) | ((period + 1) & PERIOD_MASK);
        let exchanged = self.state(group).compare_exchange(state, decision, Ordering::AcqRel, Ordering::Acquire);
        Some(exchanged.map_or_else(|other| decided(other).unwrap_or(0), |_| period))
    }

    fn state(&self, group: u64) -> &AtomicU64 {
        &self.0.states[group as usize % REMEMBERED]
    }

    /// Adds the pages that the fingers share to `memory`.
    pub(super) fn add_to(&self, memory: &mut LockedMemory) {
        memory.add_shared(&self.0);
    }
}

/// The bits of a state that hold the period.
const PERIOD_MASK: u64 = (1 << PERIOD_BITS) - 1;

/// The bits of a state that identify its group.
fn tag(group: u64) -> u64 {
    group << PERIOD_BITS
}

fn decided(state: u64) -> Option<u64> {
    (state & PERIOD_MASK).checked_sub(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_servo_that_sees_a_posted_group_decides_for_all() {
        let gate = GroupGate::new();
        let group = gate.number();
        assert_eq!(gate.period(group, || 7), None, "not posted");
        gate.post(group);
        assert_eq!(gate.clone().period(group, || 7), Some(8));
        assert_eq!(gate.period(group, || panic!("decided already")), Some(8));
    }

    #[test]
    fn a_servo_that_loses_the_race_takes_the_other_servos_decision() {
        let gate = GroupGate::new();
        let group = gate.number();
        gate.post(group);
        let other = gate.clone();
        let late = || {
            assert_eq!(other.period(group, || 9), Some(10));
            7
        };
        assert_eq!(gate.period(group, late), Some(10));
    }

    #[test]
    fn groups_do_not_take_the_states_of_others() {
        let gate = GroupGate::new();
        for _ in 0..3 * REMEMBERED as u64 {
            let group = gate.number();
            assert_eq!(gate.period(group, || 0), None, "the state of an older group");
            gate.post(group);
            assert_eq!(gate.period(group, || group), Some(group + 1));
        }
        assert_eq!(gate.period(1, || panic!("over")), Some(0), "a newer group has the place of this one");
    }
}
