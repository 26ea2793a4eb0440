//! Many queries at once, and queries that get no answer.

mod common;

use common::client::{part, request};
use common::{PATIENCE, Rig, wait_for};
use std::time::Instant;
use sun2xp_remote_protocol::{Action, Code};
use zenoh::Wait;

/// Number of queries of each kind in a flood: gets of the Status, and Requests of one client. It exceeds the number of
/// queries of either kind that may wait, and the capacity of the queue of Answers.
const MANY: usize = 500;

#[test]
fn a_query_without_an_answer_ends_at_once() {
    let rig = Rig::new("");
    let alice = rig.connect("alice");
    wait_for("a State", || alice.state());
    let begun = Instant::now();
    // A key with a wildcard belongs to no client.
    assert!(alice.ask("sun2xp/hand/acquire/*", request(Action::Acquire).encode().expect("a Request")).is_none());
    assert!(begun.elapsed() < PATIENCE / 2, "the query ended before its time limit");
    rig.server.end();
}

#[test]
fn a_flood_of_one_client_leaves_answers_for_another() {
    let rig = Rig::new("end_ms = 20000");
    let (mut alice, carol) = (rig.connect("alice"), rig.connect("carol"));
    wait_for("a State", || carol.state());
    let release = carol.keys.request(Action::Release, &carol.name);
    let payload = request(Action::Release).encode().expect("a Request");
    let mut floods = Vec::new();
    for _ in 0..MANY {
        let status = carol.session.get(carol.keys.status()).timeout(PATIENCE).wait().expect("asked");
        let refused =
            carol.session.get(release.as_str()).payload(payload.clone()).timeout(PATIENCE).wait().expect("asked");
        floods.extend([status, refused]);
    }
    let begun = Instant::now();
    assert_eq!(alice.acquire_with(request(Action::Acquire)).code, Code::Done);
    // Every query of carol ends, with an answer or without one.
    for replies in floods {
        while replies.recv().is_ok() {}
    }
    assert!(begun.elapsed() < PATIENCE / 2, "the queries ended before their time limits");
    assert!(carol.status().is_some(), "the queries of carol do not wait any more");
    let goal = [0.1, 0.5, 0.9];
    alice.repeat_until(&[part(1, goal)], "set point", |_| (rig.set_point() == goal).then_some(()));
    assert_eq!(carol.request(request(Action::Stop)).code, Code::Done);
    rig.server.end();
}
