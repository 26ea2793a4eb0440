//! Tests the ownership of a hand: who may acquire, release, take over and stop it, and which Requests and Targets the
//! server refuses.

mod common;

use common::client::{finger, part, request};
use common::{Rig, wait_for};
use sun2xp::Stage;
use sun2xp_remote_protocol::{Action, Answer, Code, HandName, Request, Target};

fn running(rig: &Rig) -> bool {
    rig.hand().report(1).expect("a report").stage == Stage::Running
}

#[test]
fn one_client_owns_the_hand_until_it_releases_it() {
    let rig = Rig::new("");
    let (mut alice, mut bob, mut carol) = (rig.connect("alice"), rig.connect("bob"), rig.connect("carol"));
    let acquired = alice.acquire_with(request(Action::Acquire));
    assert_eq!((acquired.code, acquired.catch_ms), (Code::Done, 100));
    let refused = bob.acquire_with(request(Action::Acquire));
    assert!(refused.code == Code::Owned && refused.text.contains("alice"), "{refused:?}");
    let refused = carol.acquire_with(request(Action::Acquire));
    let text = "the client carol may not make the request `acquire`: list the client in [serve.clients]";
    assert!(refused.code == Code::NotOwner && refused.text.starts_with(text), "{refused:?}");
    let released = bob.request(Request { epoch: acquired.epoch, ..request(Action::Release) });
    assert_eq!(released.code, Code::NotOwner, "the epoch of another client helps nobody");
    assert_eq!(alice.status().expect("a Status").owner.as_ref(), Some(&alice.name));
    let released = alice.request(Request { epoch: alice.epoch, ..request(Action::Release) });
    assert_eq!(released.code, Code::Done);
    wait_for("end state", || (!running(&rig)).then_some(()));
    assert_eq!(bob.acquire().code, Code::Done);
    assert!(running(&rig), "acquire has recovered the fingers");
    rig.server.end();
}

#[test]
fn a_take_over_ends_the_epoch_of_the_previous_owner() {
    let rig = Rig::new("");
    let (mut alice, mut bob) = (rig.connect("alice"), rig.connect("bob"));
    let number = alice.acquire_with(request(Action::Acquire)).number;
    let goal = [0.1, 0.5, 0.9];
    alice.repeat_until(&[part(1, goal)], "set point", |_| (rig.set_point() == goal).then_some(()));
    let taken = bob.acquire_with(Request { take_over: true, ..request(Action::Acquire) });
    assert_eq!((taken.code, taken.number), (Code::Done, number + 1));
    let before = bob.status().expect("a Status").counts;
    alice.repeat_until(&[part(2, [0.3, 0.3, 0.3])], "count", |alice| {
        (alice.status()?.counts.old_epoch > before.old_epoch).then_some(())
    });
    assert_eq!(rig.set_point(), goal);
    bob.repeat_until(&[], "State with the epoch", |bob| (bob.state()?.owner == number + 1).then_some(()));
    rig.server.end();
}

#[test]
fn anyone_who_is_listed_may_stop() {
    let rig = Rig::new("");
    let (mut alice, carol) = (rig.connect("alice"), rig.connect("carol"));
    alice.acquire_with(request(Action::Acquire));
    assert_eq!(carol.request(request(Action::Stop)).code, Code::Done);
    wait_for("stop", || (!running(&rig)).then_some(()));
    let stranger = rig.connect("mallory");
    assert_eq!(stranger.request(request(Action::Stop)).code, Code::NotOwner);
    rig.server.end();
}

#[test]
fn malformed_requests_are_refused_and_counted() {
    let rig = Rig::new("");
    let alice = rig.connect("alice");
    let key = alice.keys.request(Action::Acquire, &alice.name);
    let good = request(Action::Acquire).encode().expect("a Request");
    let mut other_version = good.clone();
    other_version[1] = 9;
    let code = |payload: &[u8]| {
        let Answer { code, text, .. } = alice.ask(&key, payload.to_vec())?;
        let remedy = if code == Code::Malformed { "Correct the client" } else { "of the same version" };
        assert!(text.contains(remedy), "{text}");
        Some(code)
    };
    assert_eq!(code(&other_version), Some(Code::OtherVersion));
    assert_eq!(code(&good[..15]), Some(Code::Malformed));
    assert_eq!(code(&[]), Some(Code::Malformed));
    assert_eq!(code(&request(Action::Stop).encode().expect("a Request")), Some(Code::Malformed), "another action");
    let status = alice.status().expect("a Status");
    assert!(status.owner.is_none() && status.counts.malformed == 4, "{status:?}");
    rig.server.end();
}

#[test]
fn targets_that_must_not_be_taken_are_counted_and_move_nothing() {
    let rig = Rig::new("catch_ms = 5000\nend_ms = 20000");
    let mut alice = rig.connect("alice");
    alice.acquire_with(request(Action::Acquire));
    let goal = [0.1, 0.5, 0.9];
    let good = alice.repeat_until(&[part(1, goal)], "set point", |alice| {
        let taken = rig.set_point() == goal;
        taken.then_some(alice.sequence)
    });
    let before = alice.status().expect("a Status").counts;
    let elsewhere = vec![part(2, [0.4, 0.4, 0.4])];
    let base = Target { validity_ms: 5000, ..alice.target(elsewhere.clone()) };
    alice.publish(&Target { sequence: good, ..base.clone() });
    alice.publish(&Target { seen: base.seen - 5_100_000_000, sequence: base.sequence + 1, ..base.clone() });
    alice.publish(&Target { epoch: base.epoch ^ 1, sequence: base.sequence + 2, ..base.clone() });
    alice.publish(&Target { seen: u64::MAX, sequence: base.sequence + 3, ..base.clone() });
    let mut damaged = base.encode().expect("a Target");
    damaged.pop();
    alice.publish_under(&alice.keys.target(&alice.name), damaged);
    let bob = rig.connect("bob");
    bob.publish_under(&bob.keys.target(&bob.name), base.encode().expect("a Target"));
    alice.publish(&Target { parts: vec![part(3, [9.0, 0.4, 0.4])], sequence: base.sequence + 4, ..base.clone() });
    let refusal = wait_for("refusal", || alice.refusal());
    assert_eq!((refusal.code, refusal.number), (Code::Argument, base.sequence + 4));
    assert!(refusal.text.contains("joint 0 would be at 9.0000 rad, outside the limits"), "{refusal:?}");
    let counts = wait_for("counts", || {
        let counts = alice.status()?.counts;
        (counts.old_epoch == before.old_epoch + 2).then_some(counts)
    });
    assert_eq!(counts.replayed, before.replayed + 1, "{counts:?}");
    assert_eq!(counts.late, before.late + 1, "{counts:?}");
    assert_eq!(counts.malformed, before.malformed + 2, "{counts:?}");
    assert_eq!(counts.refused, before.refused + 1, "{counts:?}");
    assert_eq!(rig.set_point(), goal);
    rig.server.end();
}

#[test]
fn every_hand_is_found_by_its_status() {
    let rig = Rig::new("name = 'left'");
    let client = common::Client::connect_to(&rig.endpoint, "left", "carol", None).expect("connected");
    let replies = zenoh::Wait::wait(client.session.get(sun2xp_remote_protocol::EVERY_STATUS)).expect("asked");
    let reply = replies.recv().expect("a reply");
    let key = reply.result().expect("a Status").key_expr().as_str().to_owned();
    assert_eq!(sun2xp_remote_protocol::hand_of_status(&key), "left".parse::<HandName>().ok());
    rig.server.end();
}

/// The owner falls silent during the calibration, so `catch_ms` and `end_ms` are long.
#[test]
fn a_client_whose_calibration_the_end_of_the_server_interrupts_gets_an_answer() {
    let rig = Rig::new("catch_ms = 10000\nend_ms = 60000");
    let mut alice = rig.connect("alice");
    alice.acquire_with(request(Action::Acquire));
    let calibrate = Request { finger: Some(finger(1)), epoch: alice.epoch, ..request(Action::Calibrate) };
    let asking = std::thread::spawn(move || alice.request(calibrate));
    wait_for("calibration", || (rig.hand().report(1).expect("a report").stage == Stage::Calibrating).then_some(()));
    rig.server.end();
    let answer = asking.join().expect("an answer");
    assert_eq!(answer.code, Code::Closed, "{answer:?}");
}
