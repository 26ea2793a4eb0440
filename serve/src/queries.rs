//! The callbacks of queries. They run in the threads of zenoh that receive Targets, so they never wait. They never drop
//! a query either, because the thread that drops a query also sends the end of the query, and this sending can block.

use crate::answers::Answers;
use crate::places::Place;
use crate::requests::{self, Reply};
use crate::shared::Shared;
use std::sync::Arc;
use sun2xp_remote_protocol::{Action, Answer};
use zenoh::query::Query;

/// A query whose answer is not known yet. Dropping this value ends the query without an answer, in another thread.
struct Waiting {
    answers: Answers,
    query: Option<Query>,
    /// None if too many Requests of the client wait. Then the query gets no answer.
    place: Option<Place>,
}

impl Reply for Waiting {
    fn send(mut self, answer: &Answer) {
        let Ok(bytes) = answer.encode() else { return };
        let Some(place) = self.place.take() else { return };
        if let Some(query) = self.query.take() {
            let key = query.key_expr().clone().into_owned();
            self.answers.reply(query, key, bytes, place);
        }
    }
}

impl Drop for Waiting {
    fn drop(&mut self) {
        if let Some(query) = self.query.take() {
            self.answers.end(query);
        }
    }
}

/// Takes a query whose key belongs to the Requests for this action.
pub fn on_request(shared: &Arc<Shared>, answers: &Answers, action: Action, query: Query) {
    // A key with a wildcard belongs to no client.
    let Some(client) = shared.keys.client_of_request(action, query.key_expr().as_str()) else {
        return answers.end(query);
    };
    let place = answers.place(&client);
    // A Stop is carried out even if there is no place for its answer.
    if place.is_none() && action != Action::Stop {
        return answers.end(query);
    }
    let payload = query.payload().map(|payload| payload.to_bytes().into_owned()).unwrap_or_default();
    let waiting = Waiting { answers: answers.clone(), query: Some(query), place };
    requests::answer(shared, action, client, &payload, waiting);
}
