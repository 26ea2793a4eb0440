//! Writes the events of a finger to its event log, and wakes the threads that wait for events.

use super::FingerServo;
use crate::control::Activity;
use crate::finger::Stage;
use crate::finger::events::EventLog;
use crate::realtime::{EventCount, SharedPages};

impl FingerServo {
    /// Sets the counter at which threads wait for events. All fingers of a hand have the same counter.
    pub fn with_readers(mut self, readers: SharedPages<EventCount>) -> Self {
        self.memory.add_shared(&readers);
        self.events.set_readers(readers);
        self
    }

    /// Returns the log of the finger's events.
    pub fn event_log(&self) -> &EventLog {
        self.events.log()
    }

    /// Returns whether the last cycle has published events.
    pub(in crate::finger) fn has_new_events(&self) -> bool {
        self.events.published()
    }

    /// Wakes a thread that waits for events. Makes one system call if a thread waits, and otherwise none.
    pub(in crate::finger) fn announce_events(&self) {
        self.events.announce();
    }

    /// Runs the detectors if the finger is in the stage `Running`, follows a set point and has received this cycle's
    /// reply. Writes their observations to the log.
    pub(super) fn observe(&mut self) {
        if let (Stage::Running, Activity::Follow(set_point), true) = (self.report.stage, &self.activity, self.answered)
        {
            let detectors = &self.adjustable.detectors;
            self.report.arrival = self.events.observe(detectors, &self.report.cycle, set_point);
        }
    }
}
