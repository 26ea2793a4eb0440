//! Groups of set points: a finger takes its part of a group in the same period as the other fingers of the group.

use super::FingerServo;
use crate::finger::{GroupGate, Stage};

impl FingerServo {
    /// Sets the gate that the fingers of the hand share.
    pub fn in_groups(mut self, gate: GroupGate) -> Self {
        self.mailbox.set_gate(gate, &mut self.memory);
        self
    }

    /// Begins the computation of a cycle in the period `period`, and takes the groups that take effect in it. The
    /// groups do not wait for the board's reply, so that a lost reply does not separate a group. `now` returns the
    /// number of the present period.
    pub fn take_groups(&mut self, period: u64, now: impl Fn() -> u64) {
        self.report.period = period;
        if !self.under_control() {
            return;
        }
        if let Some(sent) = self.mailbox.new_group(period, now)
            && self.report.stage == Stage::Running
        {
            self.take_set_point(&sent);
        }
    }
}
