//! Fingers that were stopped or whose boards failed: none resumes without a call, and each resumes after a call.

use crate::rig::{START, TARGET, close, goes, on_boards, on_one_port, open, three_boards, turn, wait_until};
use std::fs::read_dir;
use sun2xp::board::protocol::Status;
use sun2xp::calibration::Task;
use sun2xp::finger::{FaultKind, Stage};
use sun2xp::hand::{Calibrating, Hand, HandError, Recovering, stop_all};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, OnFault};
use sun2xp::realtime::Priority;
use sun2xp::simulated::{Defect, Pace, SimulatedBoard, SimulatedPort};

pub fn fault(hand: &Hand, finger: i32) -> Option<FaultKind> {
    match hand.report(finger).expect("a report").stage {
        Stage::Faulted(fault) => Some(fault.kind),
        _ => None,
    }
}

pub fn faults(hand: &Hand, finger: i32) -> FaultKind {
    wait_until("faulted", || fault(hand, finger).is_some());
    fault(hand, finger).expect("faulted")
}

pub fn recovers(hand: &Hand, finger: i32) {
    hand.recover(finger).unwrap_or_else(|error| panic!("finger {finger}: {error}"));
}

/// A hand whose three fingers are on one simulated port.
pub fn one_port() -> (SimulatedPort, Hand) {
    let board = SimulatedBoard::new(&Configuration::default(), &FingerNumber::ALL).expect("a board");
    let board = SimulatedPort::start(board, Pace::patient(500.0), Priority { fifo: 20, core: None }).expect("a port");
    let hand = open(on_one_port(&board.path().to_string_lossy(), 2_000_000));
    (board, hand)
}

/// Number of open descriptors and of threads of this process.
pub fn held() -> (usize, usize) {
    let count = |folder: &str| read_dir(folder).expect("a folder").count();
    (count("/proc/self/fd"), count("/proc/self/task"))
}

#[test]
fn an_emergency_stop_stops_every_finger_until_it_recovers() {
    let _turn = turn();
    let mut boards = three_boards();
    let hand = open(on_boards(&boards));
    goes(&hand, 2, TARGET);
    for _ in 0..2 {
        stop_all();
        for (index, board) in boards.iter_mut().enumerate() {
            let finger = index as i32 + 1;
            assert_eq!(faults(&hand, finger), FaultKind::EmergencyStopCall);
            let state = board.wait_for(index + 1, "ended", |state| state.has(Status::ENDED));
            assert!(state.limp() && !state.has(Status::WATCHDOG_TRIPPED), "left to the watchdog: {state:?}");
            let error = hand.send_position(finger, START).expect_err("refused");
            assert!(error.errno() == libc::EIO && error.to_string().contains("emergency stop"), "{error}");
        }
        for finger in 1..=3 {
            recovers(&hand, finger);
            // Finger 3 stays stopped until its own recovery.
            assert_eq!(fault(&hand, 3).is_some(), finger < 3);
        }
        goes(&hand, 2, START);
        goes(&hand, 3, TARGET);
    }
    // There is nothing to recover.
    recovers(&hand, 1);
    assert_eq!(hand.recover(4).expect_err("no such finger").errno(), libc::EINVAL);
    // The hand is closed while it is stopped. A hand that is opened afterwards is not affected.
    stop_all();
    faults(&hand, 1);
    close(hand);
    goes(&open(on_boards(&boards)), 1, START);
}

#[test]
fn fingers_that_stop_together_recover_one_by_one() {
    let _turn = turn();
    let mut boards = three_boards();
    let mut configuration = on_boards(&boards);
    configuration.hand.on_fault = OnFault::Hand;
    let hand = open(configuration);
    goes(&hand, 1, TARGET);
    boards[1].signal(libc::SIGSTOP);
    assert_eq!(faults(&hand, 2), FaultKind::LostReplies);
    for finger in [1, 3] {
        assert_eq!(faults(&hand, finger), FaultKind::Companion);
        boards[finger as usize - 1].wait_for(finger as usize, "ended", |state| state.has(Status::ENDED));
    }
    recovers(&hand, 1);
    goes(&hand, 1, START);
    let error = hand.recover(2).expect_err("no board answers");
    assert_eq!(error.errno(), libc::ETIMEDOUT, "{error}");
    boards[1].signal(libc::SIGCONT);
    // The board first answers the requests that arrived while it was stopped.
    recovers(&hand, 2);
    recovers(&hand, 3);
    for finger in 1..=3 {
        goes(&hand, finger, TARGET);
    }
}

#[test]
fn a_finger_that_faults_during_the_recovery_of_another_stops_it() {
    let _turn = turn();
    let [one, others] = [&[FingerNumber::ONE][..], &[FingerNumber::TWO, FingerNumber::THREE]].map(|fingers| {
        let board = SimulatedBoard::new(&Configuration::default(), fingers).expect("a board");
        SimulatedPort::start(board, Pace::patient(500.0), Priority { fifo: 20, core: None }).expect("a port")
    });
    let mut configuration = on_one_port(&others.path().to_string_lossy(), 2_000_000);
    (configuration.fingers[0].port, configuration.fingers[0].thread) = (one.path().to_string_lossy().into(), 2);
    configuration.hand.on_fault = OnFault::Hand;
    let hand = open(configuration);
    hand.stop(2).expect("finger 2");
    (1..=3)
        .for_each(|finger| assert!(matches!(faults(&hand, finger), FaultKind::Companion | FaultKind::FingerStopCall)));
    recovers(&hand, 1);
    let recovering = Recovering::begin(&hand, 2).expect("begun");
    hand.stop(1).expect("finger 1");
    assert_eq!(faults(&hand, 1), FaultKind::FingerStopCall);
    recovering.reconnect().unwrap_or_else(|error| panic!("{error}"));
    wait_until("stopped", || recovering.poll(&hand).is_err());
    assert_eq!(fault(&hand, 2), Some(FaultKind::Companion));
    (1..=3).for_each(|finger| recovers(&hand, finger));
    close(hand);
}

#[test]
fn a_board_that_lost_its_power_recovers_on_the_same_port() {
    let _turn = turn();
    let (board, hand) = one_port();
    board.with_finger(2, |finger| finger.reset()).expect("finger 2");
    assert_eq!(faults(&hand, 2), FaultKind::BoardReset);
    // Fingers 1 and 3 keep running on the same link.
    hand.send_position(1, TARGET).expect("sent");
    recovers(&hand, 2);
    goes(&hand, 1, TARGET);
    stop_all();
    for finger in 1..=3 {
        assert_eq!(faults(&hand, finger), FaultKind::EmergencyStopCall);
    }
    recovers(&hand, 2);
    for finger in 1..=3 {
        assert_eq!(fault(&hand, finger), None, "it shares the port");
        goes(&hand, finger, START);
    }
    close(hand);
}

#[test]
fn fingers_that_recover_beside_one_that_faults_again_stay_where_they_are_found() {
    let _turn = turn();
    let (board, hand) = one_port();
    goes(&hand, 2, START);
    // The finger is moving when it is stopped.
    hand.send_position(2, TARGET).expect("sent");
    stop_all();
    (1..=3).for_each(|finger| assert_eq!(faults(&hand, finger), FaultKind::EmergencyStopCall));
    let again = std::thread::scope(|scope| {
        let recovering = scope.spawn(|| hand.recover(1));
        wait_until("opening", || hand.report(1).expect("a report").stage == Stage::Opening);
        board.with_finger(1, |finger| finger.inject(&Defect::EmergencyStop)).expect("finger 1");
        recovering.join().expect("no panic")
    });
    assert!(again.expect_err("it faults again").to_string().contains("emergency stop, input"));
    wait_until("a spring", || hand.report(2).expect("a report").stage == Stage::Running);
    let found = hand.report(2).expect("a report").set_point.joints;
    hand.send_damping(2, 1.2).expect("sent");
    wait_until("taken", || hand.report(2).expect("a report").set_point.damping == 1.2);
    assert_eq!(hand.report(2).expect("a report").set_point.joints, found, "the finger moves without a set point");
    close(hand);
}

/// The recovery of a finger includes the other fingers of its port. A second caller that recovers one of those fingers
/// meanwhile waits for the recovery that is in progress.
#[test]
fn a_finger_recovers_although_another_one_of_its_port_faults_again() {
    let _turn = turn();
    let (_board, hand) = one_port();
    stop_all();
    (1..=3).for_each(|finger| assert_eq!(faults(&hand, finger), FaultKind::EmergencyStopCall));
    let stage = |finger| hand.report(finger).expect("a report").stage;
    std::thread::scope(|scope| {
        let recovering = scope.spawn(|| recovers(&hand, 1));
        wait_until("opening", || stage(3) == Stage::Opening);
        hand.stop(2).expect("finger 2");
        recovers(&hand, 3);
        assert_eq!(stage(3), Stage::Running);
        recovering.join().expect("it recovers");
    });
    assert_eq!((stage(1), fault(&hand, 2)), (Stage::Running, Some(FaultKind::FingerStopCall)));
    close(hand);
}

#[test]
fn two_threads_that_recover_fingers_of_one_port_both_succeed() {
    let _turn = turn();
    let (_board, hand) = one_port();
    stop_all();
    (1..=3).for_each(|finger| assert_ne!(faults(&hand, finger), FaultKind::Companion));
    // Both recoveries have begun before either has restored the port.
    let recovering = [1, 2].map(|finger| Recovering::begin(&hand, finger).expect("begun"));
    for recovering in &recovering {
        recovering.reconnect().unwrap_or_else(|error| panic!("{error}"));
    }
    for recovering in &recovering {
        wait_until("recovered", || recovering.poll(&hand).unwrap_or_else(|error| panic!("{error}")));
    }
    assert_eq!(hand.report(1).expect("a report").recoveries, 1);
    close(hand);
}

/// A finger shows its fault until its servo has received the restored port. Until then, another caller that recovers
/// the finger only waits.
#[test]
fn recovering_a_finger_that_was_just_repaired_does_not_report_a_shared_port() {
    let _turn = turn();
    let boards = three_boards();
    let hand = open(on_boards(&boards));
    for round in 0..10 {
        stop_all();
        assert_eq!(faults(&hand, 2), FaultKind::EmergencyStopCall);
        for _ in 0..2 {
            let recovering = Recovering::begin(&hand, 2).expect("begun");
            recovering.reconnect().unwrap_or_else(|error| panic!("round {round}: {error}"));
        }
        recovers(&hand, 2);
        assert_eq!(hand.report(2).expect("a report").recoveries, round + 1);
    }
    close(hand);
}

/// A planner's thread that does not run for a while misses the fault and the recovery.
#[test]
fn a_calibration_ends_if_its_finger_faults_and_recovers_between_two_polls() {
    let _turn = turn();
    let (_board, hand) = one_port();
    let mut calibrating = Calibrating::begin(&hand, 1, Task::Zero).expect("begun");
    wait_until("calibrating", || hand.report(1).expect("a report").stage == Stage::Calibrating);
    stop_all();
    (1..=3).for_each(|finger| assert_eq!(faults(&hand, finger), FaultKind::EmergencyStopCall));
    recovers(&hand, 1);
    let error = calibrating.poll(&hand).expect_err("no verdict will come");
    assert!(matches!(error, HandError::Interrupted(FingerNumber::ONE)), "{error}");
    // A calibration also ends without a verdict if the hand is ended.
    let mut calibrating = Calibrating::begin(&hand, 2, Task::Zero).expect("begun");
    wait_until("calibrating", || hand.report(2).expect("a report").stage == Stage::Calibrating);
    hand.end();
    let error = calibrating.poll(&hand).expect_err("no verdict will come");
    assert!(matches!(error, HandError::Interrupted(FingerNumber::TWO)), "{error}");
    close(hand);
}

/// If a recovery is refused because of the board, the port keeps its link, and a later recovery can succeed.
#[test]
fn a_finger_that_was_refused_for_its_lost_zero_recovers_when_it_is_back() {
    let _turn = turn();
    let mut boards = three_boards();
    let hand = open(on_boards(&boards));
    boards[1].order("zero-lost 2");
    assert_eq!(faults(&hand, 2), FaultKind::ZeroLost);
    for _ in 0..2 {
        let error = hand.recover(2).expect_err("without its zero");
        assert!(matches!(error, HandError::Faulted { fault, .. } if fault.kind == FaultKind::ZeroLost), "{error}");
    }
    boards[1].order("repair 2");
    recovers(&hand, 2);
    goes(&hand, 2, TARGET);
    close(hand);
}

#[test]
fn a_hand_is_closed_and_its_ports_free_while_somebody_recovers_a_finger() {
    let _turn = turn();
    let mut boards = three_boards();
    let hand = open(on_boards(&boards));
    boards[1].signal(libc::SIGSTOP);
    assert_eq!(faults(&hand, 2), FaultKind::LostReplies);
    let [recovering, late] = [(); 2].map(|()| Recovering::begin(&hand, 2).expect("begun"));
    // The recovery has the finger's link, but no board answers there.
    assert_eq!(recovering.reconnect().expect_err("no board answers").errno(), libc::ETIMEDOUT);
    hand.close();
    let error = late.reconnect().expect_err("closed");
    assert!(error.to_string().contains("was closed"), "{error}");
    boards[1].signal(libc::SIGCONT);
    // The board first carries out the requests that arrived while it was stopped.
    boards[1].wait_for(2, "at rest", |state| !state.has(Status::ENABLED));
    // Both recoveries still exist, but hold no port.
    let hand = open(on_boards(&boards));
    goes(&hand, 2, TARGET);
    drop((recovering, late));
    close(hand);
}
