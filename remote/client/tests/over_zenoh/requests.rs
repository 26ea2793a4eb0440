//! Requests whose answers are lost, and an acquire that recovers no finger.

use crate::server::{FakeServer, configuration, free_port, until};
use std::time::Duration;
use sun2xp_remote_client::{RemoteErrorKind, RemoteHand, Stage};
use sun2xp_remote_protocol::Action;

/// Just after a client has connected, Zenoh may not know the way to the server yet.
#[test]
fn the_first_get_of_the_status_is_repeated() {
    let port = free_port();
    let server = FakeServer::start(port, &["left"]);
    server.hand().lock().unanswered_status = 2;
    let hand = RemoteHand::watch(&configuration(port, "left", "screen")).expect("open");
    assert_eq!((hand.fingers().len(), server.hand().lock().unanswered_status), (2, 0));
}

/// The server may have carried out a calibration whose answer was lost. A repeated request would calibrate again.
#[test]
fn a_calibration_is_not_repeated() {
    let port = free_port();
    let server = FakeServer::start(port, &["left"]);
    let hand = RemoteHand::open(&configuration(port, "left", "planner")).expect("open");
    server.hand().lock().unanswered = 1;
    assert_eq!(hand.zero(1).expect_err("no answer").kind(), RemoteErrorKind::NotConnected);
    server.hand().lock().unanswered = 1;
    assert_eq!(hand.identify(1).expect_err("no answer").kind(), RemoteErrorKind::NotConnected);
    let requests = server.hand().lock().requests.clone();
    assert!(requests.iter().all(|request| request.action == Action::Acquire), "{requests:?}");
}

/// Zenoh ends a request at once if it reaches no server. So the server may have carried out a request that ends later
/// without an answer.
#[test]
fn a_request_that_may_have_been_carried_out_is_not_repeated() {
    let port = free_port();
    let server = FakeServer::start(port, &["left"]);
    let hand = RemoteHand::open(&configuration(port, "left", "planner")).expect("open");
    (server.hand().lock().unanswered, server.hand().lock().unanswered_after) = (1, Duration::from_secs(1));
    assert_eq!(hand.recover(None).expect_err("no answer").kind(), RemoteErrorKind::NotConnected);
}

#[test]
fn a_hand_can_be_acquired_while_its_fingers_stay_stopped() {
    let port = free_port();
    let server = FakeServer::start(port, &["left"]);
    let hand = RemoteHand::open(&configuration(port, "left", "planner")).expect("open");
    hand.release().expect("released");
    server.hand().lock().stage = Stage::Faulted(23);
    hand.acquire().expect("acquired");
    assert!(hand.is_owner());
    let (stage, request) = {
        let hand = server.hand().lock();
        (hand.stage, *hand.requests.last().expect("a request"))
    };
    assert_eq!((stage, request.action, request.recover), (Stage::Faulted(23), Action::Acquire, false));
}

/// If the stop does not arrive, the silence of the client stops the hand.
#[test]
fn after_an_emergency_stop_without_an_answer_no_targets_are_sent() {
    let port = free_port();
    let server = FakeServer::start(port, &["left"]);
    let hand = RemoteHand::open(&configuration(port, "left", "planner")).expect("open");
    server.hand().lock().unanswered = usize::MAX;
    assert_eq!(hand.emergency_stop().expect_err("no answer").kind(), RemoteErrorKind::NotConnected);
    let (sent, states) = (hand.statistics().targets, hand.statistics().states);
    hand.send_position(1, [0.5; 3]).expect("it waits");
    until("20 States", || hand.statistics().states, |&now| now > states + 20);
    assert_eq!(hand.statistics().targets, sent);
    server.hand().lock().unanswered = 0;
    hand.emergency_stop().expect("stopped");
    assert_eq!(server.hand().lock().stage, Stage::Faulted(23));
    until("Targets", || hand.statistics().targets, |&targets| targets > sent);
}
