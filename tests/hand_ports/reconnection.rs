//! A port that disappeared returns: a finger recovers on its own board only, and only on request.

use crate::attempts::attempts;
use crate::pauses::{Part, name_pauses};
use crate::recoveries::{TOLERATED_PAUSE, recovers_despite_pauses, recovers_unless};
use crate::recovery::{fault, faults, held, recovers};
use crate::rig::{Board, TARGET, close, goes, on_boards, on_one_port, on_ports, open, three_boards, turn, wait_until};
use std::fs;
use std::path::Path;
use std::time::Duration;
use sun2xp::board::LinkError;
use sun2xp::board::protocol::Status;
use sun2xp::finger::FaultKind;
use sun2xp::hand::{Hand, HandError, stop_all};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::Priority;
use sun2xp::simulated::{Defect, Pace, SimulatedBoard, SimulatedPort};

/// Three boards with a finger each, and their hand. The port of finger 2 is behind a symbolic link and may be
/// reconnected.
fn with_finger_2_on_a_link(folder: &Path) -> ([Board; 3], Hand) {
    let boards = [Board::start(&["1"]), Board::start_at(&at(folder), &["2"]), Board::start(&["3"])];
    let mut configuration = on_ports([&boards[0].port, &at(folder), &boards[2].port]);
    configuration.fingers[1].reconnect = true;
    (boards, open(configuration))
}

/// A finger does not accept another board, or its own board after that board has lost its zero.
#[test]
fn a_finger_does_not_recover_on_another_board_or_without_its_zero() {
    let _turn = turn();
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("other.toml");
    // A board with this file has the same kind and the same number, but other encoders.
    fs::write(&file, "[finger]\nencoder.counts_per_revolution = [4096, 4096, 4096, 4096]\n").expect("written");
    let ([_first, mut second, _third], hand) = with_finger_2_on_a_link(folder.path());
    let refused = |board: &Board, kind: FaultKind| {
        let reported = attempts(&format!("a recovery refused for {kind:?}"), TOLERATED_PAUSE, |watch| {
            watch.also(board.process(), Part::Board);
            match hand.recover(2) {
                Err(HandError::Faulted { finger: FingerNumber::TWO, fault }) => Ok(fault.kind),
                // A pause of the machine may delay the answers of the board.
                Err(error) => Err(error.to_string()),
                Ok(()) => panic!("recovers"),
            }
        });
        assert!(reported.iter().all(|&reported| reported == kind), "{reported:?} instead of {kind:?}");
        assert_eq!(fault(&hand, 2), Some(FaultKind::PortVanished), "the fault must stay");
    };
    second.kill();
    assert_eq!(faults(&hand, 2), FaultKind::PortVanished);
    let mut other = Board::start_with(&["--link", &at(folder.path()), "--config", &file.to_string_lossy()], &["2"]);
    refused(&other, FaultKind::IdentityChanged);
    assert!(!other.state(2).has(Status::CONFIGURED | Status::ENABLED) && other.state(2).limp());
    other.kill();
    let mut forgetful = Board::start_at(&at(folder.path()), &["2"]);
    forgetful.order("zero-lost 2");
    refused(&forgetful, FaultKind::ZeroLost);
    assert!(!forgetful.state(2).has(Status::ENABLED) && forgetful.state(2).limp());
    forgetful.order("repair 2");
    recovers_despite_pauses(&hand, 2, &[forgetful.process()]);
    goes(&hand, 2, TARGET);
    close(hand);
}

/// A board that does not keep its zeros never reports valid zeros. Its restart is visible only because it has lost its
/// terms (the values of the last Configure).
#[test]
fn a_finger_does_not_recover_if_a_board_that_does_not_keep_its_zeros_has_restarted() {
    let _turn = turn();
    let mut board = SimulatedBoard::new(&Configuration::default(), &FingerNumber::ALL).expect("a board");
    assert!(board.finger(2).expect("finger 2").inject(&Defect::ZeroLost));
    let board = SimulatedPort::start(board, Pace::patient(500.0), Priority { fifo: 20, core: None }).expect("a port");
    let hand = open(on_one_port(&board.path().to_string_lossy(), 2_000_000));
    hand.stop(2).expect("a finger");
    assert_eq!(faults(&hand, 2), FaultKind::FingerStopCall);
    recovers(&hand, 2);
    board.with_finger(2, |finger| finger.reset()).expect("finger 2");
    assert_eq!(faults(&hand, 2), FaultKind::BoardReset);
    let refused = || match hand.recover(2) {
        Err(HandError::Faulted { finger: FingerNumber::TWO, fault }) => assert_eq!(fault.kind, FaultKind::ZeroLost),
        other => panic!("not refused for its zero: {other:?}"),
    };
    // The other fingers of the port run. The first recovery gives the board its terms again, so the second recovery
    // cannot recognise the restart by missing terms.
    refused();
    refused();
    // The next recovery repairs the whole port.
    stop_all();
    for finger in [1, 3] {
        assert_eq!(faults(&hand, finger), FaultKind::EmergencyStopCall);
    }
    refused();
    close(hand);
}

#[test]
fn a_port_that_is_not_to_be_reconnected_stays_away() {
    let _turn = turn();
    let mut boards = three_boards();
    let hand = open(on_boards(&boards));
    boards[2].kill();
    assert_eq!(faults(&hand, 3), FaultKind::PortVanished);
    let error = hand.recover(3).expect_err("refused");
    assert!(error.errno() == libc::ENODEV && error.to_string().contains("finger.reconnect"), "{error}");
    goes(&hand, 1, TARGET);
    close(hand);
}

fn at(folder: &Path) -> String {
    folder.join("board-2").to_string_lossy().into_owned()
}

/// Whether this process has the port open.
fn opened(port: &str) -> bool {
    let descriptors = fs::read_dir("/proc/self/fd").expect("descriptors").flatten();
    descriptors.filter_map(|descriptor| fs::read_link(descriptor.path()).ok()).any(|file| file == Path::new(port))
}

/// `SUN2XP_ROUNDS=100 cargo test --test hand_ports unplugged -- --nocapture` runs more rounds.
#[test]
fn a_board_that_is_unplugged_again_and_again_recovers_and_nothing_leaks() {
    let _turn = turn();
    let rounds: u32 = std::env::var("SUN2XP_ROUNDS").map_or(3, |rounds| rounds.parse().expect("a number"));
    let folder = tempfile::tempdir().expect("a folder");
    let ([_first, mut second, _third], hand) = with_finger_2_on_a_link(folder.path());
    goes(&hand, 2, TARGET);
    let _rest = name_pauses().rest();
    let before = held();
    for _ in 0..rounds {
        second.kill();
        assert_eq!(faults(&hand, 2), FaultKind::PortVanished);
        let error = hand.recover(2).expect_err("no board is there");
        assert!([libc::ENOENT, libc::EIO, libc::ENOTTY].contains(&error.errno()), "{error}");
        // The port is a new device behind the old name.
        second = Board::start_at(&at(folder.path()), &["2"]);
        recovers_despite_pauses(&hand, 2, &[second.process()]);
        goes(&hand, 2, TARGET);
        assert_eq!((fault(&hand, 1), fault(&hand, 3)), (None, None), "the others must keep running");
    }
    assert_eq!(held(), before, "descriptors and threads after {rounds} rounds");
    goes(&hand, 1, TARGET);
    close(hand);
}

/// The servo does not use the link of a stopped finger, so it does not notice that the port vanishes.
#[test]
fn a_port_that_vanishes_while_its_finger_is_stopped_is_opened_again_by_the_recovery() {
    let _turn = turn();
    let folder = tempfile::tempdir().expect("a folder");
    let ([_first, mut second, _third], hand) = with_finger_2_on_a_link(folder.path());
    hand.stop(2).expect("a finger");
    assert_eq!(faults(&hand, 2), FaultKind::FingerStopCall);
    second.kill();
    let second = Board::start_at(&at(folder.path()), &["2"]);
    let of_port = |error: &HandError| matches!(error, HandError::Link { source: LinkError::Port(_), .. });
    recovers_unless(&hand, 2, &[second.process()], of_port);
    goes(&hand, 2, TARGET);
    close(hand);
}

#[test]
fn a_finger_recovers_only_on_request() {
    let _turn = turn();
    let folder = tempfile::tempdir().expect("a folder");
    let ([_first, mut second, _third], hand) = with_finger_2_on_a_link(folder.path());
    second.kill();
    faults(&hand, 2);
    let mut second = Board::start_at(&at(folder.path()), &["2"]);
    // The library opens the port and asks for the identity, but does not configure the board.
    wait_until("reopened", || opened(&second.port));
    for _ in 0..200 {
        let state = second.state(2);
        assert!(!state.has(Status::CONFIGURED | Status::ENABLED) && state.limp(), "{state:?}");
        // This pause makes the 200 queries last at least 200 ms, so that they go on until the board has answered the
        // Hello.
        std::thread::sleep(Duration::from_millis(1));
    }
    assert_eq!(fault(&hand, 2), Some(FaultKind::PortVanished));
    recovers(&hand, 2);
    assert!(second.state(2).has(Status::ENABLED));
    close(hand);
}
