//! Requests to stop and to close, which wait for no lock.

use super::{Mailbox, Requests, ServoEnd};
use crate::finger::{StopCounts, stop_calls};
use crate::realtime::atomics::Ordering;

impl Mailbox {
    /// Requests that the servo bring the finger to its end state.
    pub fn close(&self) {
        self.requests.closing.store(true, Ordering::Release);
    }

    /// Requests a stop: the finger faults at the beginning of its next cycle, and its motors enter the end state.
    pub fn stop(&self) {
        self.requests.stops.fetch_add(1, Ordering::AcqRel);
    }

    /// Returns the number of requests to stop so far.
    pub fn stops(&self) -> u32 {
        self.requests.stops.load(Ordering::Acquire)
    }

    /// Returns whether there is a request to stop, or an emergency stop call, that no recovery has answered yet. In
    /// this case the servo faults the finger at the beginning of its next cycle.
    pub fn is_stopped(&self) -> bool {
        let Requests { answered_stops, answered_calls, .. } = &*self.requests;
        self.stops() != answered_stops.load(Ordering::Acquire) || stop_calls() != answered_calls.load(Ordering::Acquire)
    }
}

impl ServoEnd {
    /// Returns whether a planner has requested the end state of the finger.
    pub fn closing(&self) -> bool {
        self.requests.closing.load(Ordering::Acquire)
    }

    /// Returns whether a planner has requested a stop of the finger that no recovery has answered yet.
    pub fn stop_requested(&self) -> bool {
        self.requests.stops.load(Ordering::Acquire) != self.requests.answered_stops.load(Ordering::Acquire)
    }

    /// Ignores the requests to stop and the emergency stop calls up to these counts.
    pub fn forget_stops(&mut self, stops: StopCounts) {
        self.requests.answered_stops.store(stops.of_finger, Ordering::Release);
        self.requests.answered_calls.store(stops.calls, Ordering::Release);
    }
}
