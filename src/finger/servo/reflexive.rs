//! The state of a finger's reflexes in its servo.

use crate::finger::ReflexServer;

/// The rules of a finger, and when it follows its planner.
#[derive(Default)]
pub(super) struct Reflexive {
    /// None if planners cannot install rules for the finger.
    pub server: Option<ReflexServer>,
    /// The period from which on the finger follows its planner again; none if it follows its planner now.
    pub inhibited_until: Option<u64>,
    /// The period of the last set point of the planner.
    pub last_set_point: u64,
}

impl Reflexive {
    /// Returns whether the finger does not follow set points of its planner.
    pub fn inhibits(&self) -> bool {
        self.inhibited_until.is_some()
    }

    /// Notes a set point of the planner in this period.
    pub fn note_set_point(&mut self, period: u64) {
        self.last_set_point = period;
    }
}
