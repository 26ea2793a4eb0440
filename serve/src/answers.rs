//! Sends Answers in threads of their own. A client that has stopped reading can hold up a reply, and the threads of
//! zenoh that receive Targets must not wait for it. The client chooses the congestion control of its query, and the
//! reply has the same one. Zenoh 1.10 ignores a congestion control that is set for the reply.
//!
//! When a thread drops a query, zenoh sends the end of the query in this thread. This sending can block too. So
//! callbacks pass every query to one of the threads that send Answers, even a query that gets no answer.

use crate::places::{Place, Places};
use crate::shared::Shared;
use crate::status::status;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::time::Duration;
use sun2xp::realtime::now;
use sun2xp_remote_protocol::ClientName;
use zenoh::bytes::ZBytes;
use zenoh::key_expr::KeyExpr;
use zenoh::query::Query;
use zenoh::{Session, Wait};

/// Capacity of the queue of Answers to Requests. When it is full, further Answers are dropped. Their queries end
/// without an answer.
const WAITING: usize = 256;

/// Capacity of the queue of the other queries. Each of them takes up a few hundred bytes.
const OTHERS: usize = 16_384;

/// Interval at which a thread checks whether the server has ended.
const INTERVAL: Duration = Duration::from_millis(50);

/// A message that is to be sent.
pub enum Outgoing {
    /// The reply to a Request, under this key.
    Reply(Query, KeyExpr<'static>, Vec<u8>, Place),
    /// The refusal of a Target of this client.
    Refusal(ClientName, Vec<u8>),
    /// The reply to a query for the Status.
    Status(Query, Place),
    /// The end of a query that has no answer.
    End(Query),
}

/// Where callbacks put what is to be sent.
#[derive(Clone)]
pub struct Answers {
    requests: SyncSender<Outgoing>,
    others: SyncSender<Outgoing>,
    places: Places,
}

/// The receiving ends of the queues. Each is for a thread that calls [`send`].
pub struct Queues {
    /// Answers to Requests, and refusals of Targets.
    pub requests: Receiver<Outgoing>,
    /// Everything else. It cannot hold up an answer to a Request.
    pub others: Receiver<Outgoing>,
}

impl Answers {
    /// Returns the sending ends of the queues, and the receiving ends.
    #[must_use]
    pub fn new() -> (Self, Queues) {
        let (requests, of_requests) = sync_channel(WAITING);
        let (others, of_others) = sync_channel(OTHERS);
        let answers = Self { requests, others, places: Places::default() };
        (answers, Queues { requests: of_requests, others: of_others })
    }

    /// Returns a place for a Request of this client; none if too many of its Requests wait.
    #[must_use]
    pub fn place(&self, client: &ClientName) -> Option<Place> {
        self.places.take(Some(client.clone()))
    }

    /// Replies to a Request.
    pub fn reply(&self, query: Query, key: KeyExpr<'static>, bytes: Vec<u8>, place: Place) {
        if let Err(TrySendError::Full(Outgoing::Reply(query, ..))) =
            self.requests.try_send(Outgoing::Reply(query, key, bytes, place))
        {
            self.end(query);
        }
    }

    /// Sends the refusal of a Target. A refusal for which there is no room is dropped.
    pub fn refuse(&self, client: ClientName, bytes: Vec<u8>) {
        let _ = self.requests.try_send(Outgoing::Refusal(client, bytes));
    }

    /// Replies with the Status. If too many queries for the Status wait, this one gets no answer.
    pub fn status(&self, query: Query) {
        match self.places.take(None) {
            Some(place) => self.put_other(Outgoing::Status(query, place)),
            None => self.end(query),
        }
    }

    /// Ends a query without an answer.
    pub fn end(&self, mut query: Query) {
        // The query may wait in the queue, and its payload is no longer needed.
        if let Some(payload) = query.payload_mut() {
            *payload = ZBytes::new();
        }
        self.put_other(Outgoing::End(query));
    }

    fn put_other(&self, outgoing: Outgoing) {
        // This queue becomes full only if a client keeps sending queries faster than the server can refuse them. Then
        // further queries end here, in the thread that receives them, because the memory of the server is limited.
        let _ = self.others.try_send(outgoing);
    }
}

/// Sends what is put into the queue. When the server ends, this function first sends the Answers to the Requests that
/// were still in progress, and then returns.
pub fn send(shared: &Shared, session: &Session, queue: &Receiver<Outgoing>) {
    while !shared.answered.load(Ordering::Acquire) {
        if let Ok(outgoing) = queue.recv_timeout(INTERVAL) {
            send_one(shared, session, outgoing);
        }
    }
    // The last Answers are in the queue by now. The number of messages is limited here, so that a client that keeps
    // sending queries cannot hold up the end of the server.
    queue.try_iter().take(WAITING).for_each(|outgoing| send_one(shared, session, outgoing));
}

/// Sends a message. A failure needs no reaction: either the client has gone, or the server ends.
fn send_one(shared: &Shared, session: &Session, outgoing: Outgoing) {
    match outgoing {
        Outgoing::Reply(query, key, bytes, place) => {
            let _ = query.reply(key, bytes).wait();
            // The place stays in use until the end of the query has been sent.
            drop(query);
            drop(place);
        }
        Outgoing::Refusal(client, bytes) => {
            let _ = session.put(shared.keys.refused(&client), bytes).wait();
        }
        Outgoing::Status(query, place) => {
            reply_status(shared, &query);
            drop(query);
            drop(place);
        }
        Outgoing::End(query) => drop(query),
    }
}

fn reply_status(shared: &Shared, query: &Query) {
    let encoded = status(&shared.hand, &shared.settings.limits, &shared.desk.lock(), now()).encode();
    if let Ok(bytes) = encoded {
        let _ = query.reply(shared.keys.status(), bytes).wait();
    }
}
