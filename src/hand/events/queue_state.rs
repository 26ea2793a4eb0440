//! The state of an event queue. The thread that makes the descriptor of the queue readable has access to it too.

use super::merging::{MergedEvents, Next};
use super::source::EventSource;
use crate::finger::events::Event;
use crate::realtime::{Mutex, now};
use std::sync::Arc;

/// Interval at which a waiting thread checks whether another finger has finished its cycle, ns.
const HELD_BACK_CHECK: u64 = 100_000;

/// The state of a queue.
pub(super) struct QueueState {
    pub source: Arc<EventSource>,
    merged: Mutex<Merged>,
}

struct Merged {
    events: MergedEvents,
    /// An event that a waiting thread has found. The next [`QueueState::take`] returns it.
    found: Option<Event>,
}

impl QueueState {
    pub fn new(source: Arc<EventSource>) -> Self {
        let merged = Mutex::new(Merged { events: MergedEvents::new(&source), found: None });
        Self { source, merged }
    }

    /// Takes the earliest event.
    pub fn take(&self) -> Option<Event> {
        let mut merged = self.merged.lock();
        merged.found.take().or_else(|| match merged.events.next(now()) {
            Next::Event(event) => Some(event),
            Next::Waiting(_) | Next::Nothing => None,
        })
    }

    /// Waits until there is an event, the hand is closed, or `deadline`, ns, has passed. Returns whether there is an
    /// event. Returns early if `stop` returns true.
    pub fn wait_until(&self, deadline: u64, stop: impl Fn() -> bool) -> bool {
        loop {
            let prepared = self.source.readers.prepare();
            let closed = self.source.is_closed();
            let recheck = match self.look() {
                Next::Event(_) => return true,
                _ if closed || stop() || now() >= deadline => return false,
                Next::Waiting(due) => due.min(now() + HELD_BACK_CHECK),
                Next::Nothing => u64::MAX,
            };
            self.source.readers.wait(prepared, deadline.min(recheck));
        }
    }

    /// Finds the earliest event without taking it.
    fn look(&self) -> Next {
        let mut merged = self.merged.lock();
        if let Some(event) = merged.found {
            return Next::Event(event);
        }
        let next = merged.events.next(now());
        if let Next::Event(event) = next {
            merged.found = Some(event);
        }
        next
    }

    /// Returns the number of events that were lost.
    pub fn lost(&self) -> u64 {
        self.merged.lock().events.lost()
    }

    /// Discards all events up to now.
    pub fn clear(&self) {
        let mut merged = self.merged.lock();
        merged.events.clear();
        merged.found = None;
    }
}
