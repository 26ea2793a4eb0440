//! The state of an event queue, which the queue shares with the thread that makes the queue's descriptor readable.

use super::merging::{MergedEvents, Next};
use super::source::EventSource;
use crate::finger::events::Event;
use crate::realtime::{Mutex, now};
use std::sync::Arc;

/// Interval at which a waiting thread checks whether a held-back event can be taken, ns. An event is held back while
/// another finger has not finished its cycle and may still have an earlier event.
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
                _ if stop() || now() >= deadline => return false,
                // The last events of a closed hand are held back too.
                Next::Waiting(due) => due.min(now() + HELD_BACK_CHECK),
                Next::Nothing if closed => return false,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::finger::events::{EventKind, Occurrence, event_log};
    use crate::model::{FingerNumber, Part};
    use crate::realtime::{EventCount, Pages};

    #[test]
    fn an_event_that_is_held_back_when_the_hand_is_closed_ends_the_wait() {
        let (mut writers, logs): (Vec<_>, Vec<_>) = FingerNumber::ALL.map(event_log).into_iter().unzip();
        let period = 1_000_000;
        let source = EventSource::new(logs, Pages::new(EventCount::default()).into(), period);
        let queue = QueueState::new(Arc::new(source));
        // The other fingers have not finished this cycle, so the event is held back.
        let began = now() + 20 * period;
        writers[0].begin_cycle(1, began);
        writers[0].write(Occurrence { kind: EventKind::Contact, part: Part::Finger, values: [0.0; 4] });
        writers[0].publish(began + period);
        queue.source.close();
        assert!(queue.take().is_none());
        assert!(queue.wait_until(u64::MAX, || false));
        assert!(queue.take().is_some());
        assert!(!queue.wait_until(u64::MAX, || false));
    }
}
