//! How a client notices that it does not own the hand any more.

use super::*;

#[test]
fn a_client_that_lost_the_hand_is_told_why() {
    let mut exchange = owner();
    exchange.take_state(&State { owner: 3, ..state(2, 11 * MS, Stage::Running) }, 11 * MS);
    let (kind, text) = refused(send(&mut exchange, good(1), 11 * MS));
    assert_eq!(kind, RemoteErrorKind::NotOwner);
    assert!(text.contains("another client has acquired it"), "{text}");
    assert!(exchange.moving(1, 11 * MS).is_ok(), "it can still read");
}

#[test]
fn a_server_that_was_started_again_is_noticed() {
    for restarted in [state(1, 20 * MS, Stage::Running), State { time: 7 * MS, ..state(9, 0, Stage::Running) }] {
        let mut exchange = owner();
        exchange.take_state(&State { owner: 0, ..restarted }, 30 * MS);
        let (kind, text) = refused(send(&mut exchange, good(1), 30 * MS));
        assert!(kind == RemoteErrorKind::NotOwner && text.contains("the server was started again"), "{text}");
    }
    let mut exchange = owner();
    let other = State { owner: 0, ..state(9, 20 * MS, Stage::Running) };
    exchange.take_state(&other, 30 * MS);
    assert!(refused(send(&mut exchange, good(1), 30 * MS)).1.contains("the server has ended the ownership"));
}

/// The server was started again. Its Answer to an acquire arrives before its first State.
#[test]
fn an_epoch_of_a_server_that_was_started_again_is_kept() {
    let mut exchange = owner();
    exchange.outbox.acquired(&Answer { epoch: 78, time: SERVER + 20 * MS, number: 9, ..answer() });
    exchange.take_state(&State { owner: 0, ..state(1, 15 * MS, Stage::Running) }, 21 * MS);
    exchange.take_state(&State { owner: 9, ..state(2, 25 * MS, Stage::Running) }, 26 * MS);
    send(&mut exchange, good(1), 26 * MS).expect("this client owns the hand");
}
