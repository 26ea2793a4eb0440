//! Boards that fail while the hand is open: the finger faults with a reason, and the others keep running.

use crate::rig::{START, TARGET, close, goes, on_boards, on_one_port, open, three_boards, turn, wait_until};
use sun2xp::board::protocol::Status;
use sun2xp::finger::{Fault, FaultKind};
use sun2xp::hand::Hand;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::Priority;
use sun2xp::simulated::{Pace, SimulatedBoard, SimulatedFinger, SimulatedPort};

/// Waits for the fault of a finger, and returns the error text of its calls.
fn fault_text(hand: &Hand, finger: i32) -> String {
    wait_until("faulted", || hand.position(finger).is_err());
    let refused = [
        hand.position(finger).map(drop),
        hand.send_position(finger, START),
        hand.send_stiffness(finger, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    ];
    let [text, ..] = refused.map(|result| {
        let error = result.expect_err("faulted");
        assert_eq!(error.errno(), libc::EIO, "{error}");
        error.to_string()
    });
    assert!(text.starts_with(&format!("finger {finger} is faulted (fault ")), "{text}");
    text
}

fn fault(hand: &Hand, finger: i32) -> Fault {
    hand.fault(finger).expect("there is such a finger").stopped.expect("faulted")
}

#[test]
fn a_board_that_dies_faults_its_finger_only() {
    let _turn = turn();
    for one_thread in [false, true] {
        let mut boards = three_boards();
        let mut configuration = on_boards(&boards);
        if one_thread {
            configuration.fingers.iter_mut().for_each(|finger| finger.thread = 3);
        }
        let hand = open(configuration);
        goes(&hand, 2, TARGET);
        boards[1].kill();
        let text = fault_text(&hand, 2);
        assert!(text.contains("port vanished") && text.contains("unplugged"), "{text}");
        assert!(matches!(fault(&hand, 2), Fault { kind: FaultKind::PortVanished, .. }));
        goes(&hand, 1, TARGET);
        goes(&hand, 3, TARGET);
        close(hand);
        assert!(boards[0].state(1).limp());
    }
}

#[test]
fn a_silent_board_faults_its_finger_and_the_watchdog_brings_the_board_to_its_end_state() {
    let _turn = turn();
    let mut boards = three_boards();
    let hand = open(on_boards(&boards));
    goes(&hand, 1, TARGET);
    boards[0].signal(libc::SIGSTOP);
    let text = fault_text(&hand, 1);
    assert!(text.contains("lost replies (998 ms)"), "{text}");
    goes(&hand, 2, TARGET);
    close(hand);
    boards[0].signal(libc::SIGCONT);
    boards[0].wait_for(1, "ended", |state| state.has(Status::ENDED) && state.limp());
    // No old bytes are left in the line.
    goes(&open(on_boards(&boards)), 1, START);
}

/// One board for all fingers, in this process, and a hand on it. Tests can disturb and examine its fingers directly.
fn own_board() -> (SimulatedPort, Hand) {
    let board = SimulatedBoard::new(&Configuration::default(), &FingerNumber::ALL).expect("a board");
    let port = SimulatedPort::start(board, Pace::patient(500.0), Priority { fifo: 20, core: None })
        .expect("a pseudo-terminal");
    let hand = open(on_one_port(&port.path().to_string_lossy(), 2_000_000));
    (port, hand)
}

fn with_finger<R>(board: &SimulatedPort, finger: u8, act: impl FnOnce(&mut SimulatedFinger) -> R) -> R {
    board.with_finger(finger, act).expect("the board has the finger")
}

#[test]
fn a_finger_that_lost_its_configuration_faults_and_its_neighbours_keep_running() {
    let _turn = turn();
    let (board, hand) = own_board();
    goes(&hand, 2, TARGET);
    with_finger(&board, 2, SimulatedFinger::reset);
    let text = fault_text(&hand, 2);
    assert!(text.contains("not configured") && text.contains("lost its power"), "{text}");
    for finger in [1, 3] {
        assert!(with_finger(&board, finger, |finger| finger.enabled()));
        goes(&hand, finger.into(), TARGET);
    }
    close(hand);
    goes(&open(on_one_port(&board.path().to_string_lossy(), 2_000_000)), 2, TARGET);
}

#[test]
fn the_emergency_stop_input_faults_the_finger_and_the_fault_has_the_status_bits() {
    let _turn = turn();
    let (board, hand) = own_board();
    with_finger(&board, 3, |finger| finger.set_faults(Status::EMERGENCY_STOP));
    let text = fault_text(&hand, 3);
    let Fault { kind, value: status, .. } = fault(&hand, 3);
    assert_eq!(kind, FaultKind::EmergencyStopInput);
    assert!(Status(status as u16).has(Status::EMERGENCY_STOP) && text.contains("status bits"), "{text}");
    goes(&hand, 1, TARGET);
    close(hand);

    // The hand does not open while the emergency stop is pressed, and opens afterwards.
    let port = board.path().to_string_lossy().into_owned();
    let error = Hand::open(on_one_port(&port, 2_000_000)).err().expect("refused").to_string();
    assert!(error.contains("finger 3") && error.contains("emergency stop"), "{error}");
    with_finger(&board, 3, |finger| finger.set_faults(Status::default()));
    goes(&open(on_one_port(&port, 2_000_000)), 3, TARGET);
}
