//! Distributes the messages of the hand to all pages. A page that has just connected first gets all that it must know.

use axum::extract::ws::Utf8Bytes;
use std::collections::{BTreeMap, VecDeque};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tokio::sync::broadcast::{self, Receiver, Sender};

/// Number of messages that a page may be behind before it loses some. The sender never waits.
const WAITING: usize = 64;

/// Number of events that a new page gets.
const EVENTS: usize = 500;

/// Kind of a message. It determines whether a page that connects later gets the message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A new hand. A new page gets nothing that was published before this message.
    Hand,
    /// There is no hand. The message gives the reason. A new page gets the newest one.
    Gone,
    /// Samples. A new page gets only later samples.
    Batch,
    /// State of a finger. A new page gets the newest one.
    State(i32),
    /// Status of a finger. A new page gets the newest one.
    Status(i32),
    /// Events. A new page gets the last [`EVENTS`].
    Events,
}

/// A message to the pages, as JSON.
#[derive(Clone, Debug)]
pub struct Update {
    /// Its kind.
    pub kind: Kind,
    /// Its text.
    pub text: Utf8Bytes,
}

/// The messages, and what a new page gets.
pub struct Hub {
    sender: Sender<Update>,
    now: Mutex<Now>,
}

#[derive(Default)]
struct Now {
    hand: Option<Utf8Bytes>,
    gone: Option<Utf8Bytes>,
    states: BTreeMap<i32, Utf8Bytes>,
    statuses: BTreeMap<i32, Utf8Bytes>,
    events: VecDeque<Utf8Bytes>,
}

impl Hub {
    /// Returns a hub without a hand.
    pub fn new() -> Self {
        Self { sender: broadcast::channel(WAITING).0, now: Mutex::default() }
    }

    /// Sends a message to all pages.
    pub fn publish(&self, kind: Kind, text: String) {
        let text = Utf8Bytes::from(text);
        let mut now = self.now();
        match kind {
            Kind::Hand => *now = Now { hand: Some(text.clone()), ..Now::default() },
            Kind::Gone => now.gone = Some(text.clone()),
            Kind::Batch => {}
            Kind::State(finger) => drop(now.states.insert(finger, text.clone())),
            Kind::Status(finger) => drop(now.statuses.insert(finger, text.clone())),
            Kind::Events => {
                now.events.push_back(text.clone());
                if now.events.len() > EVENTS {
                    now.events.pop_front();
                }
            }
        }
        // An error means that there is no page. The lock is still held. So a page that connects at this moment gets the
        // message at most once: either from this call or from `subscribe`.
        let _ = self.sender.send(Update { kind, text });
    }

    /// Returns the messages that a new page must know, and the receiver of the later messages.
    pub fn subscribe(&self) -> (Vec<Utf8Bytes>, Receiver<Update>) {
        let now = self.now();
        let parts = now.hand.iter().chain(now.states.values()).chain(now.statuses.values());
        let known = parts.chain(&now.events).chain(&now.gone).cloned().collect();
        (known, self.sender.subscribe())
    }

    fn now(&self) -> MutexGuard<'_, Now> {
        self.now.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(parts: &[Utf8Bytes]) -> Vec<&str> {
        parts.iter().map(Utf8Bytes::as_str).collect()
    }

    #[test]
    fn a_new_page_gets_the_newest_state_and_all_events_but_no_samples() {
        let hub = Hub::new();
        for (kind, text) in [
            (Kind::Hand, "hand"),
            (Kind::State(1), "opening"),
            (Kind::Batch, "batch"),
            (Kind::Events, "first"),
            (Kind::State(1), "running"),
            (Kind::Events, "second"),
        ] {
            hub.publish(kind, text.into());
        }
        let (known, mut later) = hub.subscribe();
        assert_eq!(texts(&known), ["hand", "running", "first", "second"]);
        hub.publish(Kind::Batch, "next".into());
        assert_eq!(later.try_recv().expect("a message").text.as_str(), "next");
        hub.publish(Kind::Gone, "gone".into());
        assert_eq!(texts(&hub.subscribe().0).last(), Some(&"gone"));
        hub.publish(Kind::Hand, "another".into());
        assert_eq!(texts(&hub.subscribe().0), ["another"]);
    }

    #[test]
    fn a_page_that_does_not_read_loses_messages_and_delays_nobody() {
        let hub = Hub::new();
        let (_, mut slow) = hub.subscribe();
        for number in 0..10 * WAITING {
            hub.publish(Kind::Batch, number.to_string());
        }
        let lost = slow.try_recv().expect_err("messages are lost");
        assert!(matches!(lost, broadcast::error::TryRecvError::Lagged(count) if count >= 9 * WAITING as u64));
        assert!(slow.try_recv().is_ok());
    }
}
