//! The faults that a simulated finger reports.

use super::{SimulatedFinger, State};
use crate::board::protocol::Status;

impl SimulatedFinger {
    /// Sets the faults that are present: bits of [`Status::FAULTS`]. A fault sets the torques to zero at once.
    pub fn set_faults(&mut self, faults: Status) {
        self.present = Status(faults.0 & Status::FAULTS.0);
        self.latched |= self.present;
        if self.present != Status::default() {
            self.torques = [0; 4];
            if self.state != State::Idle {
                self.state = State::Ended { holds_until: None };
            }
        }
    }

    /// Adds faults to those that are present.
    pub(in crate::simulated) fn add_faults(&mut self, faults: Status) {
        self.set_faults(self.present | faults);
    }
}
