//! A queue of a hand's events. Planners take events, wait for events, or poll a descriptor that is readable while there
//! are events.

use super::queue_state::QueueState;
use super::readiness::Readiness;
use super::source::EventSource;
use crate::finger::events::Event;
#[cfg(feature = "internals")]
use crate::finger::events::EventLog;
#[cfg(feature = "internals")]
use crate::realtime::{EventCount, SharedPages};
use crate::realtime::{Mutex, now};
use std::io;
use std::os::fd::RawFd;
use std::sync::Arc;
use std::time::Duration;

/// A queue of all events of a hand, in the order of their times. All functions may be called from several threads. Each
/// event is then returned to only one of these threads.
///
/// A queue that is not read loses the oldest events, and counts them. Events are in order unless the servo of a finger
/// is late by more than two periods. In that case the events of this finger come after later events of the other
/// fingers. The time of an event is always that of its cycle.
pub struct EventQueue {
    shared: Arc<QueueState>,
    readiness: Mutex<Option<Readiness>>,
}

impl EventQueue {
    pub(super) fn new(source: Arc<EventSource>) -> Self {
        Self { shared: Arc::new(QueueState::new(source)), readiness: Mutex::new(None) }
    }

    /// Returns a queue of the events in `logs`, which do not belong to a hand. It is for benchmarks. The writers of the
    /// logs notify `readers`. `period` is in ns.
    #[cfg(feature = "internals")]
    pub fn of_logs(logs: Vec<EventLog>, readers: SharedPages<EventCount>, period: u64) -> Self {
        Self::new(Arc::new(EventSource::new(logs, readers, period)))
    }

    /// Takes the earliest event. Returns none if there is no event now.
    #[must_use]
    pub fn next(&self) -> Option<Event> {
        let event = self.shared.take();
        if event.is_none()
            && let Some(readiness) = &*self.readiness.lock()
        {
            readiness.queue_is_empty();
        }
        event
    }

    /// Waits for an event, and takes it. The wait lasts at most `limit`; it has no limit if `limit` is none. Returns
    /// none if the limit has passed, or if the hand is closed and no event is left.
    #[must_use]
    pub fn wait(&self, limit: Option<Duration>) -> Option<Event> {
        let deadline = deadline(limit);
        while self.shared.wait_until(deadline, || false) {
            // Another thread may have taken the event.
            if let Some(event) = self.next() {
                return Some(event);
            }
        }
        None
    }

    /// Waits like [`EventQueue::wait`], but does not take the event. Returns whether there is one. Another thread may
    /// take it meanwhile.
    #[must_use]
    pub fn wait_until_ready(&self, limit: Option<Duration>) -> bool {
        self.shared.wait_until(deadline(limit), || false)
    }

    /// Returns whether the hand is closed or being closed. While it is being closed, events may still come.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.shared.source.is_closed()
    }

    /// Returns the number of events that this queue has lost because they were not taken in time. The oldest are lost
    /// first.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.shared.lost()
    }

    /// Discards all events up to now.
    pub fn clear(&self) {
        self.shared.clear();
    }

    /// Returns a descriptor for poll(2) and select(2). The descriptor is readable while there is an event, and when the
    /// hand is closed. While the hand is open, the descriptor becomes unreadable when [`EventQueue::next`] finds no
    /// event. The caller must not read, write or close the descriptor, which is closed with the queue.
    ///
    /// # Errors
    /// Returns the system's error if it cannot create the descriptor or its thread.
    pub fn descriptor(&self) -> io::Result<RawFd> {
        let mut readiness = self.readiness.lock();
        if let Some(readiness) = &*readiness {
            return Ok(readiness.number());
        }
        let started = Readiness::start(self.shared.clone())?;
        Ok(readiness.insert(started).number())
    }

    /// Returns the state of the queue. A listener needs it for a wait that can also end without an event.
    pub(super) fn state(&self) -> &QueueState {
        &self.shared
    }
}

fn deadline(limit: Option<Duration>) -> u64 {
    let limit = limit.and_then(|limit| u64::try_from(limit.as_nanos()).ok());
    limit.map_or(u64::MAX, |limit| now().saturating_add(limit))
}
