//! Queues of events.

use std::collections::VecDeque;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};
use sun2xp_remote_protocol::Event;

/// The number of events that a queue keeps.
const KEPT: usize = 4096;

/// A queue of all events of a hand. All functions may be called from several threads. If several threads take events,
/// each event is returned to only one of these threads. A queue that is not read loses the oldest events, and counts
/// them.
///
/// The time and the number of the cycle of an event are those of the server.
pub struct RemoteEvents(Arc<Queue>);

struct Queue {
    state: Mutex<QueueState>,
    changed: Condvar,
}

#[derive(Default)]
struct QueueState {
    events: VecDeque<Event>,
    /// The number of the newest event.
    newest: Option<u64>,
    lost: u64,
    closed: bool,
}

impl Queue {
    fn lock(&self) -> MutexGuard<'_, QueueState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn put(&self, event: Event) {
        let mut state = self.lock();
        // A restarted server counts from 1, so a number that is not above the newest one shows no loss.
        let lost = state.newest.filter(|&newest| newest < event.number).map_or(0, |newest| event.number - newest - 1);
        state.newest = Some(event.number);
        state.lost = state.lost.saturating_add(lost);
        if state.events.len() == KEPT {
            state.events.pop_front();
            state.lost = state.lost.saturating_add(1);
        }
        state.events.push_back(event);
        drop(state);
        self.changed.notify_all();
    }

    fn close(&self) {
        self.lock().closed = true;
        self.changed.notify_all();
    }
}

impl RemoteEvents {
    /// Takes the earliest event. Returns none if there is no event now.
    #[must_use]
    pub fn next(&self) -> Option<Event> {
        self.0.lock().events.pop_front()
    }

    /// Waits for an event for at most `limit`, or without a limit if it is none, and takes the event. Returns none
    /// after the limit, or if the hand is closed and no event is left.
    #[must_use]
    pub fn wait(&self, limit: Option<Duration>) -> Option<Event> {
        self.when_ready(limit).events.pop_front()
    }

    /// Waits like [`RemoteEvents::wait`], but does not take the event. Returns whether there is one. Another thread may
    /// take it meanwhile.
    #[must_use]
    pub fn wait_until_ready(&self, limit: Option<Duration>) -> bool {
        !self.when_ready(limit).events.is_empty()
    }

    /// Returns the state when there is an event, after the limit, or when the hand is closed.
    fn when_ready(&self, limit: Option<Duration>) -> MutexGuard<'_, QueueState> {
        let deadline = limit.and_then(|limit| Instant::now().checked_add(limit));
        let mut state = self.0.lock();
        while state.events.is_empty() && !state.closed {
            let Some(deadline) = deadline else {
                state = self.0.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
                continue;
            };
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                break;
            }
            state = self.0.changed.wait_timeout(state, left).unwrap_or_else(PoisonError::into_inner).0;
        }
        state
    }

    /// Returns the number of events that were lost: on the way, or because they were not taken in time.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.0.lock().lost
    }

    /// Discards all events up to now.
    pub fn clear(&self) {
        self.0.lock().events.clear();
    }

    /// Returns whether the hand is closed. No events arrive after the hand is closed.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.0.lock().closed
    }
}

/// Gives events to queues.
#[derive(Default)]
pub struct EventSource(Mutex<Vec<Weak<Queue>>>);

impl EventSource {
    fn queues(&self) -> MutexGuard<'_, Vec<Weak<Queue>>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns a new queue of the events from now on.
    pub fn subscribe(&self) -> RemoteEvents {
        let queue = Arc::new(Queue { state: Mutex::default(), changed: Condvar::new() });
        self.queues().push(Arc::downgrade(&queue));
        RemoteEvents(queue)
    }

    /// Gives an event to every queue.
    pub fn put(&self, event: Event) {
        self.queues().retain(|queue| queue.upgrade().inspect(|queue| queue.put(event)).is_some());
    }

    /// Closes every queue.
    pub fn close(&self) {
        self.queues().drain(..).filter_map(|queue| queue.upgrade()).for_each(|queue| queue.close());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sun2xp_remote_protocol::Finger;

    fn event(number: u64) -> Event {
        Event { finger: Finger::ALL[0], part: 0, kind: 12, number, cycle: number, begin: 0, values: [0.0; 4] }
    }

    #[test]
    fn every_queue_gets_every_event_in_order() {
        let source = EventSource::default();
        let (one, other) = (source.subscribe(), source.subscribe());
        (1..=3).for_each(|number| source.put(event(number)));
        for queue in [&one, &other] {
            let numbers: Vec<u64> = std::iter::from_fn(|| queue.next()).map(|event| event.number).collect();
            assert_eq!((numbers, queue.lost()), (vec![1, 2, 3], 0));
        }
    }

    #[test]
    fn lost_events_are_counted() {
        let source = EventSource::default();
        let queue = source.subscribe();
        [5, 6, 9, 1].iter().for_each(|&number| source.put(event(number)));
        assert_eq!(queue.lost(), 2, "7 and 8 are lost; 1 is the first event of a new server");
        (2..).take(KEPT).for_each(|number| source.put(event(number)));
        assert_eq!((queue.lost(), queue.next().map(|event| event.number)), (6, Some(2)));
    }

    #[test]
    fn numbers_without_sense_do_not_overflow() {
        let source = EventSource::default();
        let queue = source.subscribe();
        [1, u64::MAX, 1, u64::MAX].iter().for_each(|&number| source.put(event(number)));
        assert_eq!(queue.lost(), u64::MAX);
    }

    #[test]
    fn a_closed_queue_does_not_wait() {
        let source = EventSource::default();
        let queue = source.subscribe();
        source.put(event(1));
        source.close();
        assert!(queue.wait(None).is_some() && queue.wait(None).is_none() && queue.is_closed());
    }
}
