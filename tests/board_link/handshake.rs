//! Tests the handshake: the terms on which both sides agree, the errors of a failed handshake, and how long the link
//! waits for boards.

use crate::other_end::OtherEnd;
use crate::rig::{MS, board, cycle, in_time, link, pull, read, terms};
use sun2xp::board::protocol::*;
use sun2xp::board::*;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, EndState};
use sun2xp::simulated::*;

#[test]
fn a_handshake_agrees_on_terms_in_whole_counts() {
    let mut hand = Configuration::default();
    hand.fingers[2].encoder.zero = [1_000_000, -5, 0, 70_000];
    let board = SimulatedBoard::new(&hand, &[FingerNumber::THREE]).unwrap();
    let mut link = Link::new(SimulatedCable::new(board));
    let deadline = in_time(&mut link, 500);
    let (identity, configured) = link.shake_hands(3, &terms(EndState::Hold), deadline).unwrap();
    assert_eq!((identity.version, identity.addresses, identity.gauge_bits), (1, 1 << 3, 12));
    assert_eq!(identity.counts_per_revolution, 2000);
    assert!(configured.encoders[0].abs_diff(1_000_000) < 20_000 && configured.encoders[3].abs_diff(70_000) < 20_000);
    assert_eq!(configured.terms.watchdog_ms, 18);
    // The limits of the configuration, rounded down to whole torque units of the board.
    for limit in configured.terms.torque_limits {
        let limit = identity.torque(limit as i16);
        assert!(limit <= 4.75 && limit > 4.75 - identity.torque(1));
    }
    assert_eq!(configured.terms.torque_constants, [23_400; 4]);
    assert_eq!(configured.status, Status::CONFIGURED | Status::ZERO_VALID);
    assert_eq!(link.counters(), LinkCounters { bytes: 45 + 66, frames: 2, ..Default::default() });
}

fn failure(answer: impl FnMut(Message) -> Vec<u8>) -> (LinkError, u64) {
    let mut link = Link::new(OtherEnd::new(answer, Vec::new()));
    let error = link.shake_hands(1, &terms(EndState::Hold), 1000 * MS).unwrap_err();
    (error, link.transport().now())
}

/// A good board, except that `change` alters its answers.
fn good_but(change: impl Fn(&mut Message)) -> impl FnMut(Message) -> Vec<u8> {
    let mut good = board(&[1]);
    move |request| {
        let mut wire = Vec::new();
        good.receive(0, WireFrame::new(&request).as_bytes(), &mut |answer| {
            let mut message = read(answer);
            change(&mut message);
            wire.extend(WireFrame::new(&message).as_bytes());
        });
        wire
    }
}

#[test]
fn a_failed_handshake_names_its_reason() {
    let (error, when) = failure(|_| Vec::new());
    assert!(matches!(error, LinkError::Silent { milliseconds: 1000 }) && when == 1000 * MS, "{error}");
    assert_eq!(error.errno(), libc::ETIMEDOUT);

    let (error, _) = failure(|_| vec![0x55, 0xAA, 0, 0x13, 0]);
    assert!(matches!(error, LinkError::Unintelligible { .. }) && error.to_string().contains("baud"), "{error}");

    let mut elsewhere = board(&[4, 7]);
    let (error, when) = failure(move |request| {
        let mut wire = Vec::new();
        elsewhere.receive(0, WireFrame::new(&request).as_bytes(), &mut |answer| wire.extend(answer));
        wire
    });
    assert!(matches!(error, LinkError::WrongAddress { address: 1, .. }), "{error}");
    assert!(error.to_string().contains("it has 4, 7:") && when < 1000 * MS, "{error}");

    let other_version = |message: &mut Message| {
        message.frame = Frame::Refused(Refused { request: 1, reason: Reason::Version, detail: 0x0302 });
    };
    let (error, when) = failure(good_but(other_version));
    assert!(matches!(error, LinkError::WrongVersion { lowest: 2, highest: 3 }) && when == 0, "{error}");
    let error = Link::new(OtherEnd::new(good_but(other_version), Vec::new())).identities(1000 * MS).unwrap_err();
    assert!(matches!(error, LinkError::WrongVersion { lowest: 2, highest: 3 }), "{error}");

    let (error, _) = failure(good_but(|message| {
        if let Frame::Configured(configured) = &mut message.frame {
            configured.terms.watchdog_ms += 1;
        }
    }));
    assert!(matches!(error, LinkError::OtherTerms { address: 1 }), "{error}");

    let (error, _) = failure(good_but(|message| message.sequence ^= 1));
    assert!(matches!(error, LinkError::Unanswered { request: Kind::Hello, .. }), "{error}");

    let (error, _) = failure(good_but(|message| {
        if let Frame::Identity(identity) = &mut message.frame {
            identity.shortest_watchdog_ms = 50;
        }
    }));
    assert!(matches!(error, LinkError::Terms(TermsError::Watchdog { shortest: 50, wanted: 18 })), "{error}");

    let (error, _) = failure(good_but(|message| {
        if let Frame::Identity(identity) = &mut message.frame {
            identity.capabilities = Capabilities(0);
        }
    }));
    assert!(matches!(error, LinkError::Terms(TermsError::Hold)), "{error}");

    let (error, _) = failure(good_but(|message| {
        if let Frame::Identity(identity) = &mut message.frame {
            identity.torque_limit = 100;
        }
    }));
    assert!(matches!(error, LinkError::Terms(TermsError::TorqueLimit { motor: 1, .. })), "{error}");
}

/// docs/board-protocol.md permits a shortest watchdog time of up to 20 ms, and the configured time is 18 ms.
#[test]
fn a_board_whose_shortest_watchdog_is_longer_than_configured_gets_its_shortest() {
    let shake_hands = |shortest| {
        let answer = good_but(move |message| {
            if let Frame::Identity(identity) = &mut message.frame {
                identity.shortest_watchdog_ms = shortest;
            }
        });
        Link::new(OtherEnd::new(answer, Vec::new())).shake_hands(1, &terms(EndState::Hold), 1000 * MS)
    };
    for (shortest, agreed) in [(18, 18), (19, 19), (20, 20)] {
        let (identity, configured) = shake_hands(shortest).unwrap();
        assert_eq!((identity.shortest_watchdog_ms, configured.terms.watchdog_ms), (shortest, agreed));
    }
    let error = shake_hands(21).unwrap_err();
    assert!(matches!(error, LinkError::Terms(TermsError::Watchdog { shortest: 21, wanted: 18 })), "{error}");
}

#[test]
fn a_finger_that_does_not_answer_does_not_hide_the_others_of_its_board() {
    let mut good = board(&[1, 2, 3]);
    let answer = move |request: Message| {
        let mut wire = Vec::new();
        if request.address != 2 {
            good.receive(0, WireFrame::new(&request).as_bytes(), &mut |answer| wire.extend(answer));
        }
        wire
    };
    let mut link = Link::new(OtherEnd::new(answer, Vec::new()));
    let found = link.identities(160 * MS).unwrap();
    assert_eq!(found.iter().map(|&(address, _)| address).collect::<Vec<_>>(), [1, 3]);
    assert_eq!(link.transport().now(), 100 * MS);
}

#[test]
fn handshake_waits_for_a_board_that_is_starting() {
    let mut asked = 0;
    let mut starting = good_but(|_| {});
    let answer = move |request| {
        asked += 1;
        if asked < 5 { Vec::new() } else { starting(request) }
    };
    let mut link = Link::new(OtherEnd::new(answer, Vec::new()));
    assert!(link.shake_hands(1, &terms(EndState::Hold), 1000 * MS).is_ok());
}

#[test]
fn handshake_waits_until_the_watchdog_of_a_dead_host_has_tripped() {
    let mut link = link(&[1]);
    link.shake_hands(1, &terms(EndState::Release), 500 * MS).unwrap();
    cycle(&mut link, 0, pull(3000));
    // The finger still runs for the old host. The board refuses a new host until the watchdog has tripped.
    let began = link.transport().now();
    link.shake_hands(1, &terms(EndState::Release), began + 500 * MS).unwrap();
    assert!(link.transport().now() - began >= 19 * MS);
}
