//! Tests what a planner's calls report: while it owns a hand, after it has lost the hand, and when the server is gone.

use crate::server::{FakeServer, LIMIT, configuration, free_port, until};
use sun2xp_remote_client::{
    Event, Finger, FingerCommand, RemoteError, RemoteErrorKind, RemoteHand, Stage, discover, send_together,
};
use sun2xp_remote_protocol::{Action, PathPose, Place};
use zenoh::Wait;

const ONE: Finger = Finger::ALL[0];
const TWO: Finger = Finger::ALL[1];

fn kind<T: std::fmt::Debug>(result: Result<T, RemoteError>) -> RemoteErrorKind {
    result.expect_err("an error").kind()
}

#[test]
fn a_set_point_goes_to_the_finger_and_its_position_comes_back() {
    let port = free_port();
    let server = FakeServer::start(port, &["left"]);
    let hand = RemoteHand::open(&configuration(port, "left", "planner")).expect("open");
    assert!(hand.is_owner());
    assert_eq!((hand.name().as_str(), hand.fingers()), ("left", vec![ONE, TWO]));
    assert_eq!(hand.position(1).expect("a position"), [0.25; 3]);
    hand.send_position(1, [0.5, 0.75, 1.0]).expect("sent");
    until("the position", || hand.position(1).expect("a position"), |joints| *joints == [0.5, 0.75, 1.0]);
    let tip = hand.fingertip(1).expect("a tip");
    assert_eq!((tip.tip, tip.force, tip.tensions), ([1.0, 2.0, 3.0], [0.5, 0.0, 0.0], [5.0, 6.0, 7.0, 8.0]));
    let request = server.hand().lock().requests[0];
    assert_eq!((request.action, request.recover, request.take_over), (Action::Acquire, true, false));
    assert_eq!(kind(hand.position(3)), RemoteErrorKind::NotInHand);
    assert_eq!(hand.statistics().malformed, 0);
}

#[test]
fn targets_are_repeated_with_rising_numbers() {
    let port = free_port();
    let server = FakeServer::start(port, &["left"]);
    let hand = RemoteHand::open(&configuration(port, "left", "planner")).expect("open");
    hand.send_group(&[FingerCommand::new(1).joints([0.5; 3]), FingerCommand::new(2).damping(0.75)]).expect("sent");
    server.hand().wait_until("50 Targets", |hand| hand.targets.len() >= 50);
    let targets = server.hand().lock().targets.clone();
    for pair in targets.windows(2) {
        assert!(pair[0].sequence < pair[1].sequence && pair[0].sent <= pair[1].sent && pair[0].seen <= pair[1].seen);
    }
    assert!(targets[0].seen < targets[49].seen, "what the server has published is seen");
    let group = targets.iter().find(|target| !target.parts.is_empty()).expect("a Target with parts");
    assert_eq!(group.parts.len(), 2, "both parts are in the same Target");
    assert_eq!(group.parts[1].damping, Some(0.75));
}

#[test]
fn a_refusal_is_reported_by_the_next_call() {
    let port = free_port();
    let server = FakeServer::start(port, &["left"]);
    let hand = RemoteHand::open(&configuration(port, "left", "planner")).expect("open");
    server.hand().lock().refuse = Some("the tip is out of reach: send a nearer one".into());
    hand.send_tip(1, [100.0, 0.0, 0.0]).expect("sent");
    until("the refusal", || hand.statistics().refused, |&refused| refused == 1);
    let error = hand.send_position(1, [0.5; 3]).expect_err("refused");
    assert_eq!(error.kind(), RemoteErrorKind::Refused);
    assert!(error.to_string().ends_with("the tip is out of reach: send a nearer one"), "{error}");
    hand.send_position(1, [0.5; 3]).expect("sent");
    let target = server.hand().wait_for_target("joints", |target| {
        target.parts.first().is_some_and(|part| part.place == Place::Joints([0.5; 3]))
    });
    assert_eq!(target.parts.len(), 1);
}

#[test]
fn one_client_commands_and_another_may_take_over() {
    let port = free_port();
    let server = FakeServer::start(port, &["left"]);
    let first = RemoteHand::open(&configuration(port, "left", "first")).expect("open");
    let refused = RemoteHand::open(&configuration(port, "left", "second")).map(drop).expect_err("owned");
    assert_eq!(refused.kind(), RemoteErrorKind::Owned);
    assert!(refused.to_string().contains("first owns the hand"), "{refused}");
    let mut over = configuration(port, "left", "second");
    over.take_over = true;
    let second = RemoteHand::open(&over).expect("it takes over");
    until("the loss", || first.is_owner(), |owner| !owner);
    assert_eq!(kind(first.send_position(1, [0.5; 3])), RemoteErrorKind::NotOwner);
    assert_eq!(kind(first.recover(None)), RemoteErrorKind::NotOwner);
    assert_eq!(first.position(1).expect("it reads"), [0.25; 3]);
    assert_eq!(kind(first.reopen()), RemoteErrorKind::Owned);
    second.close().expect("released");
    first.reopen().expect("it is free");
    first.send_position(1, [0.5; 3]).expect("sent");
    until("the position", || first.position(1).expect("a position"), |joints| *joints == [0.5; 3]);
    drop(first);
    let hand = server.hand().lock();
    assert!(hand.owner.is_none(), "dropping releases");
}

#[test]
fn a_watcher_reads_and_may_stop() {
    let port = free_port();
    let server = FakeServer::start(port, &["left"]);
    let owner = RemoteHand::open(&configuration(port, "left", "planner")).expect("open");
    let watcher = RemoteHand::watch(&configuration(port, "left", "screen")).expect("open");
    assert!(!watcher.is_owner());
    assert_eq!(watcher.position(2).expect("a position"), [0.25; 3]);
    assert_eq!(kind(watcher.send_position(1, [0.5; 3])), RemoteErrorKind::NotOwner);
    watcher.stop(None).expect("stopped");
    let error = until("the fault", || owner.position(1), Result::is_err).expect_err("faulted");
    assert_eq!((error.kind(), error.fault()), (RemoteErrorKind::Faulted, 23));
    assert_eq!(kind(owner.send_position(1, [0.5; 3])), RemoteErrorKind::Faulted);
    assert_eq!(owner.record(1).expect("a record").stage, Stage::Faulted(23));
    owner.recover(Some(1)).expect("recovered");
    until("the position", || owner.position(1), Result::is_ok).expect("a position");
    assert_eq!(kind(owner.zero(2)), RemoteErrorKind::Busy);
    drop(watcher);
    assert!(server.hand().lock().owner.is_some(), "a watcher does not release");
}

#[test]
fn events_come_in_order() {
    let port = free_port();
    let server = FakeServer::start(port, &["left"]);
    let hand = RemoteHand::watch(&configuration(port, "left", "screen")).expect("open");
    let queue = hand.events();
    let event = |number| Event { finger: TWO, part: 1, kind: 12, number, cycle: 7, begin: 8, values: [0.5; 4] };
    server.hand().lock().events = vec![event(5), event(3), event(2)];
    let received: Vec<_> = (0..3).filter_map(|_| queue.wait(Some(LIMIT))).collect();
    assert_eq!(received, [event(2), event(3), event(5)]);
    assert_eq!(queue.lost(), 1);
    drop(hand);
    assert!(queue.wait(None).is_none() && queue.is_closed());
}

#[test]
fn malformed_messages_are_counted_and_change_nothing() {
    let port = free_port();
    let server = FakeServer::start(port, &["left"]);
    let hand = RemoteHand::open(&configuration(port, "left", "planner")).expect("open");
    let session = server.hand().lock().session.clone().expect("a session");
    let mut state = server.hand().lock().state(u64::MAX).encode().expect("a State");
    state.push(0);
    let other_version = [2, 2];
    for (key, payload) in [
        ("sun2xp/left/state", state.as_slice()),
        ("sun2xp/left/state", &other_version),
        ("sun2xp/left/status", &[4, 1, 0]),
        ("sun2xp/left/events", &[]),
        ("sun2xp/left/refused/planner", &[6, 1]),
    ] {
        session.put(key, payload).wait().expect("put");
    }
    until("the count", || hand.statistics().malformed, |&malformed| malformed == 5);
    assert_eq!(hand.position(1).expect("a position"), [0.25; 3]);
    hand.send_position(1, [0.5; 3]).expect("sent");
    until("the position", || hand.position(1).expect("a position"), |joints| *joints == [0.5; 3]);
}

#[test]
fn a_server_that_falls_silent_is_noticed() {
    let port = free_port();
    let server = FakeServer::start(port, &["left"]);
    let mut short = configuration(port, "left", "planner");
    short.stale_ms = 300;
    let hand = RemoteHand::open(&short).expect("open");
    server.hand().lock().silent = true;
    let error = until("the age", || hand.position(1), Result::is_err).expect_err("stale");
    assert_eq!(error.kind(), RemoteErrorKind::Stale, "{error}");
    let error = until("the silence", || hand.send_position(1, [0.5; 3]), Result::is_err).expect_err("silent");
    assert_eq!(error.kind(), RemoteErrorKind::NotConnected, "{error}");
    server.hand().lock().silent = false;
    until("the position", || hand.position(1), Result::is_ok).expect("fresh");
}

#[test]
fn after_a_restart_of_the_server_the_hand_is_read_but_not_acquired() {
    let port = free_port();
    let server = FakeServer::start(port, &["left"]);
    let mut short = configuration(port, "left", "planner");
    short.stale_ms = 500;
    let hand = RemoteHand::open(&short).expect("open");
    hand.send_position(1, [0.5; 3]).expect("sent");
    server.hand().wait_for_target("the set point", |target| !target.parts.is_empty());
    // First the client receives more than 20 States of the first server. The newest of them then has a higher number
    // than the first States of the new server.
    until("States", || hand.statistics().states, |&states| states > 20);
    drop(server);
    until("the age", || hand.position(1), Result::is_err).expect_err("stale");
    let server = FakeServer::start(port, &["left"]);
    let joints = until("the position", || hand.position(1), Result::is_ok).expect("fresh");
    assert_eq!(joints, [0.25; 3], "the set point was not sent again");
    assert_eq!(kind(hand.send_position(1, [0.5; 3])), RemoteErrorKind::NotOwner);
    assert!(server.hand().lock().requests.is_empty(), "it does not acquire by itself");
    hand.reopen().expect("acquired");
    hand.send_position(1, [0.75; 3]).expect("sent");
    until("the position", || hand.position(1).expect("fresh"), |joints| *joints == [0.75; 3]);
}

#[test]
fn hands_are_found_and_commanded_together() {
    let port = free_port();
    let server = FakeServer::start(port, &["right", "left"]);
    let found = discover(&configuration(port, "none", "planner")).expect("hands");
    let names: Vec<_> = found.iter().map(|hand| hand.name.as_str()).collect();
    assert_eq!(names, ["left", "right"]);
    assert!(found[0].status.owner.is_none());
    let left = RemoteHand::open(&configuration(port, "left", "planner")).expect("open");
    let right = RemoteHand::open(&configuration(port, "right", "planner")).expect("open");
    let (one, other) = ([FingerCommand::new(1).joints([0.5; 3])], [FingerCommand::new(2).joints([0.75; 3])]);
    assert_eq!(kind(send_together(&[(&left, &one), (&left, &other)])), RemoteErrorKind::Argument);
    let far = [FingerCommand::new(1).joints([9.0; 3])];
    assert_eq!(kind(send_together(&[(&left, &one), (&right, &far)])), RemoteErrorKind::OutOfRange);
    send_together(&[(&right, &other), (&left, &one)]).expect("sent");
    let sent = server.hands().iter().map(|hand| hand.wait_for_target("parts", |target| !target.parts.is_empty()));
    let sent: Vec<_> = sent.collect();
    assert_eq!(sent[0].sent, sent[1].sent, "one time stamp");
    let places: Vec<_> = sent.iter().map(|target| (target.parts[0].finger, target.parts[0].place.clone())).collect();
    assert_eq!(places, [(TWO, Place::Joints([0.75; 3])), (ONE, Place::Joints([0.5; 3]))], "refused calls send nothing");
}

/// Just after a client has connected, Zenoh may not know the way to the server yet.
#[test]
fn a_request_that_reaches_nobody_is_repeated() {
    let port = free_port();
    let server = FakeServer::start(port, &["left"]);
    server.hand().lock().unanswered = 2;
    let hand = RemoteHand::open(&configuration(port, "left", "planner")).expect("open");
    assert!(hand.is_owner());
    server.hand().lock().unanswered = usize::MAX;
    let error = hand.recover(None).expect_err("nobody answers");
    assert_eq!(error.kind(), RemoteErrorKind::NotConnected);
    assert!(
        error.to_string().contains("the request `recover` has no answer. Check the line and the server"),
        "{error}"
    );
}

#[test]
fn an_open_that_fails_says_why() {
    let port = free_port();
    let error = RemoteHand::open(&configuration(port, "left", "planner")).map(drop).expect_err("nobody listens");
    assert_eq!(error.kind(), RemoteErrorKind::NotConnected);
    assert!(error.to_string().contains("start `sun2xp serve` there"), "{error}");
    let server = FakeServer::start(port, &["left"]);
    let error = RemoteHand::open(&configuration(port, "right", "planner")).map(drop).expect_err("another hand");
    assert_eq!(error.kind(), RemoteErrorKind::NotConnected);
    assert!(error.to_string().contains("cannot reach the hand \"right\"") && error.to_string().contains("remote.hand"));
    server.hand().lock().version = 2;
    let error = RemoteHand::open(&configuration(port, "left", "planner")).map(drop).expect_err("another version");
    assert_eq!(error.kind(), RemoteErrorKind::Protocol);
    assert!(error.to_string().contains("(the version of the protocol is 2, and not 1): use a client"), "{error}");
}

#[test]
fn a_path_can_be_sent_right_after_a_recovery() {
    let port = free_port();
    let server = FakeServer::start(port, &["left"]);
    let hand = RemoteHand::open(&configuration(port, "left", "planner")).expect("open");
    let opens = || hand.record(1).expect("a record").stage == Stage::Opening;
    (server.hand().lock().stage, server.hand().lock().late_states) = (Stage::Opening, 4);
    until("the State of a finger that opens", opens, |&opens| opens);
    hand.recover(Some(1)).expect("recovered");
    let pose = PathPose { time: 1.0, joints: [0.5; 3] };
    hand.send_path(1, &[pose]).expect("the State after the recovery is known");
}
