//! The unique numbers of boards: no two ports of a hand may have boards with the same number.

use crate::rig::{START, TARGET, close, goes, on_ports, open, turn};
use sun2xp::hand::Hand;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::Priority;
use sun2xp::simulated::{Pace, SimulatedBoard, SimulatedPort};

fn start(board: SimulatedBoard) -> SimulatedPort {
    SimulatedPort::start(board, Pace::patient(500.0), Priority { fifo: 20, core: None }).expect("a pseudo-terminal")
}

/// Boards with finger 1 that differ in nothing but these numbers.
fn copies(numbers: [u32; 3]) -> [SimulatedPort; 3] {
    let board = || SimulatedBoard::new(&Configuration::default(), &[FingerNumber::ONE]).expect("a board");
    numbers.map(|number| start(board().numbered(number)))
}

fn on_copies(boards: &[SimulatedPort; 3]) -> Configuration {
    let ports = boards.each_ref().map(|board| board.path().to_string_lossy().into_owned());
    let mut configuration = on_ports(ports.each_ref().map(String::as_str));
    configuration.fingers.iter_mut().for_each(|finger| finger.address = 1);
    configuration
}

#[test]
fn two_boards_with_one_number_are_refused() {
    let _turn = turn();
    let boards = copies([7, 8, 7]);
    let error = Hand::open(on_copies(&boards)).err().expect("refused");
    assert_eq!(error.errno(), libc::ENOTUNIQ);
    let text = error.to_string();
    let ports = [0, 2].map(|index| boards[index].path().display().to_string());
    for part in ["fingers 1 ", "and 3 ", &ports[0], &ports[1], "73 75 6E 32 78 70 00 00 00 07 01 01", "firmware"] {
        assert!(text.contains(part), "{part:?} is not in: {text}");
    }
    for board in &boards {
        let torques = board.with_finger(1, |finger| finger.motor_torques()).expect("finger 1");
        assert_eq!(torques.amax(), 0.0, "its motors stay off");
    }
}

#[test]
fn boards_that_differ_only_in_their_numbers_are_accepted() {
    let _turn = turn();
    let boards = copies([7, 8, 9]);
    let hand = open(on_copies(&boards));
    goes(&hand, 3, TARGET);
    close(hand);
}

#[test]
fn built_in_boards_have_unique_numbers_whatever_their_addresses() {
    let _turn = turn();
    let mut configuration = Configuration::default();
    configuration.fingers.iter_mut().for_each(|finger| finger.address = 1);
    let hand = open(configuration);
    goes(&hand, 2, START);
    close(hand);
}
