//! Sends Answers in a thread of their own. A client that has stopped to read can hold up a reply for seconds, and the
//! threads of zenoh that receive Targets must not wait for it.

use crate::shared::Shared;
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::Duration;
use sun2xp_remote_protocol::ClientName;
use zenoh::key_expr::KeyExpr;
use zenoh::query::Query;
use zenoh::{Session, Wait};

/// Most Answers that wait. Further ones are dropped, and their clients ask again.
const WAITING: usize = 256;

/// Interval at which the thread looks whether the server ends.
const INTERVAL: Duration = Duration::from_millis(50);

/// A message that is to be sent.
pub enum Outgoing {
    /// The reply to a query, under this key.
    Reply(Query, KeyExpr<'static>, Vec<u8>),
    /// The refusal of a Target of this client.
    Refusal(ClientName, Vec<u8>),
}

/// Where callbacks put what is to be sent.
#[derive(Clone)]
pub struct Answers(SyncSender<Outgoing>);

impl Answers {
    /// Returns a queue, and its end for [`send`].
    #[must_use]
    pub fn new() -> (Self, Receiver<Outgoing>) {
        let (sender, receiver) = sync_channel(WAITING);
        (Self(sender), receiver)
    }

    /// Puts a message into the queue, and never waits.
    pub fn put(&self, outgoing: Outgoing) {
        // A message for which there is no room is dropped.
        let _ = self.0.try_send(outgoing);
    }
}

/// Sends what is in the queue until the server ends.
pub fn send(shared: &Shared, session: &Session, queue: &Receiver<Outgoing>) {
    while !shared.ending.load(Ordering::Acquire) {
        // A client that has gone needs no answer, and the session is closed only when the server ends.
        let _ = match queue.recv_timeout(INTERVAL) {
            Ok(Outgoing::Reply(query, key, bytes)) => query.reply(key, bytes).wait(),
            Ok(Outgoing::Refusal(client, bytes)) => session.put(shared.keys.refused(&client), bytes).wait(),
            Err(_) => Ok(()),
        };
    }
}
