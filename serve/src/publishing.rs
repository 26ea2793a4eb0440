//! What the server publishes by itself: a State every 5 ms, Events, and a Status every second. One thread does all of
//! this. It is not real-time, because a subscriber whose connection is full can delay a message by a millisecond.

use crate::ServeError;
use crate::cycles::{Cycles, Taken};
use crate::shared::Shared;
use crate::status::status;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use sun2xp::events::{Event, EventKind, EventQueue};
use sun2xp::nalgebra::Vector3;
use sun2xp::realtime::{Clock, MonotonicClock, now};
use sun2xp_remote_protocol::{Event as Message, FieldError, Finger, State};
use zenoh::pubsub::Publisher;
use zenoh::qos::CongestionControl;
use zenoh::{Session, Wait};

/// Interval of States, ns.
const STATE_INTERVAL: u64 = 5_000_000;

/// States from one Status to the next.
const STATES_PER_STATUS: u64 = 200;

/// Largest number of Events that are published between two States. Later Events stay in the queue.
const MOST_EVENTS: usize = 64;

/// The publishers of a hand.
pub struct Publishing {
    shared: Arc<Shared>,
    cycles: Cycles,
    events: EventQueue,
    state: Publisher<'static>,
    event: Publisher<'static>,
    status: Publisher<'static>,
    /// Number of States that were published.
    states: u64,
    /// Number of Events that were published.
    sent_events: u64,
}

impl Publishing {
    /// Declares the publishers.
    ///
    /// # Errors
    /// Returns an error if zenoh refuses them.
    pub fn new(shared: &Arc<Shared>, session: &Session) -> Result<Self, ServeError> {
        let declare = |key: String| {
            let publisher = session.declare_publisher(key.clone()).congestion_control(CongestionControl::Drop);
            publisher.express(true).wait().map_err(|error| ServeError::undeclared(&key, error))
        };
        let events = shared.hand.events();
        events.clear();
        Ok(Self {
            cycles: Cycles::new(shared.hand.clone()),
            events,
            state: declare(shared.keys.state())?,
            event: declare(shared.keys.events())?,
            status: declare(shared.keys.status())?,
            states: 0,
            sent_events: 0,
            shared: shared.clone(),
        })
    }

    /// Publishes until the server ends.
    pub fn run(mut self) {
        let mut next = now();
        while !self.shared.ending.load(Ordering::Acquire) {
            self.publish();
            // A late thread does not catch up: the next State has the cycles of both intervals.
            next = (next + STATE_INTERVAL).max(now());
            MonotonicClock.sleep_until(next);
        }
    }

    fn publish(&mut self) {
        let (goals, progress, epoch) = {
            let desk = self.shared.desk.lock();
            (desk.goals(), desk.progress(), desk.epoch_number())
        };
        let Taken { mut records, missing } = self.cycles.take(&goals, &progress);
        self.states += 1;
        let (time, owner) = {
            // The time and the epoch are read under one lock of the desk. Otherwise this State could have a later time
            // than an Answer, but an earlier epoch.
            let desk = self.shared.desk.lock();
            (now(), desk.epoch_number())
        };
        if owner != epoch {
            // The goals were those of the previous owner, who may have used the same command numbers.
            for record in &mut records {
                (record.command, record.arrived, record.settled) = (0, false, false);
            }
        }
        let missing = u32::try_from(missing).unwrap_or(u32::MAX);
        send(&self.state, State { missing, number: self.states, time, owner, records }.encode());
        for _ in 0..MOST_EVENTS {
            let Some(event) = self.events.next() else { break };
            if self.is_of_destination(&event) {
                self.publish_event(&event);
            }
        }
        if self.states % STATES_PER_STATUS == 1 {
            let shared = &self.shared;
            let encoded = status(&shared.hand, &shared.settings.limits, &shared.desk.lock(), now()).encode();
            send(&self.status, encoded);
        }
    }

    /// Returns false for an arrival at a place that is not the owner's destination. Such a place is either an
    /// intermediate set point, which the server sends if the destination is too far ahead of the finger (see
    /// [`crate::lead`]), or the place where the finger was caught (see [`crate::silence`]).
    fn is_of_destination(&self, event: &Event) -> bool {
        if event.kind != EventKind::Arrived {
            return true;
        }
        let index = event.finger.index();
        let tolerance = self.shared.hand.configuration().fingers[index].events.arrived_degrees.to_radians();
        let [first, second, third, _] = event.values;
        // The goal is read after the event, because the owner may have sent a new destination since the State was made.
        let goal = self.shared.desk.lock().goals()[index];
        // An intermediate set point can be within the tolerance of the destination. So an arrival counts only if the
        // whole way has been sent.
        (goal.whole || !goal.is_commanded()) && goal.is_reached(&Vector3::new(first, second, third), tolerance)
    }

    fn publish_event(&mut self, event: &Event) {
        // Gaps in the numbers show clients that the queue has lost Events.
        self.sent_events += 1;
        let Some(finger) = Finger::new(event.finger.get()) else { return };
        let sent = Message {
            finger,
            part: event.part.number(),
            kind: u16::from(event.kind.number()),
            number: self.sent_events + self.events.lost(),
            cycle: event.cycle,
            begin: event.time,
            values: event.values,
        };
        send(&self.event, sent.encode());
    }
}

/// Sends a message. A message that the protocol does not allow is not sent. The server makes such a message only if a
/// number is not finite.
fn send(publisher: &Publisher<'_>, encoded: Result<Vec<u8>, FieldError>) {
    if let Ok(bytes) = encoded {
        // The session is closed only when the server ends.
        let _ = publisher.put(bytes).wait();
    }
}
