//! The events of a hand for planners. Planners take events from queues, and wait for events at queues. Listeners get
//! the events in a thread of their own.
//!
//! Every queue and every listener gets all events. Each has its own position in the logs of the fingers, so none takes
//! an event away from another.

mod listener;
mod merging;
mod queue;
mod queue_state;
mod readiness;
mod source;

pub use listener::EventListener;
pub(super) use merging::{MergedEvents, Next};
pub use queue::EventQueue;
pub(super) use source::EventSource;

use crate::finger::events::Event;
use crate::hand::{Hand, HandError};

impl Hand {
    /// Returns a new queue of the hand's events. It begins with the oldest events that the fingers' logs still hold.
    /// Each log holds the newest 4096 events of its finger.
    pub fn events(&self) -> EventQueue {
        EventQueue::new(self.events.clone())
    }

    /// Calls `callback` with each event from now on, in an ordinary thread of its own, until the listener is dropped or
    /// the hand is closed. The second argument is the number of events that the listener has lost because the callback
    /// was too slow. The oldest events are lost first. The callback may make every call of the hand. While it runs,
    /// later events wait.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn on_event(&self, callback: impl FnMut(&Event, u64) + Send + 'static) -> Result<EventListener, HandError> {
        let queue = self.events();
        queue.clear();
        EventListener::start(queue, callback)
            .map_err(|source| HandError::System { doing: "start a thread for events", source })
    }
}
