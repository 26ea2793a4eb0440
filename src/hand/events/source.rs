//! What the servos share with the readers of their events.

use crate::finger::events::EventLog;
use crate::realtime::{EventCount, SharedPages};
use std::sync::atomic::{AtomicBool, Ordering};

/// The logs of a hand's fingers. They outlive the hand while a queue or a listener exists.
pub struct EventSource {
    pub(super) logs: Vec<EventLog>,
    /// The threads that wait for events.
    pub(super) readers: SharedPages<EventCount>,
    /// Whether the hand is closed or being closed.
    closed: AtomicBool,
    /// Length of a period of the servos, ns.
    pub(super) period: u64,
}

impl EventSource {
    /// The servos of all fingers notify `readers`. `period` is in ns.
    pub fn new(logs: Vec<EventLog>, readers: SharedPages<EventCount>, period: u64) -> Self {
        Self { logs, readers, closed: AtomicBool::new(false), period }
    }

    /// Ends each wait as soon as no event is left for it, because the hand is being closed.
    pub fn close(&self) {
        self.closed.store(true, Ordering::Release);
        self.readers.notify();
    }

    pub(super) fn is_closed(&self) -> bool {
        self.closed.load(Ordering::Acquire)
    }
}
