//! The state of a finger's reflexes in its servo.

use crate::finger::reflexes::Bulletin;
use crate::finger::{ReflexServer, reflexes};
use crate::model::FingerNumber;
use crate::realtime::LockedMemory;

/// The rules of a finger, and when it follows its planner.
pub(super) struct Reflexive {
    pub server: ReflexServer,
    /// The period from which on the finger follows its planner again; none if it follows its planner now.
    pub inhibited_until: Option<u64>,
    /// The period of the last set point of the planner.
    pub last_set_point: u64,
}

impl Reflexive {
    /// Constructs a finger without rules, which reads no events of others. Adds its pages to `memory`.
    pub fn new(finger: FingerNumber, memory: &mut LockedMemory) -> Self {
        let (_, server) = reflexes(finger, &Bulletin::new());
        memory.append(server.memory());
        Self { server, inhibited_until: None, last_set_point: 0 }
    }

    /// Returns whether the finger does not follow set points of its planner.
    pub fn inhibits(&self) -> bool {
        self.inhibited_until.is_some()
    }

    /// Notes a set point of the planner in this period.
    pub fn note_set_point(&mut self, period: u64) {
        self.last_set_point = period;
    }
}
