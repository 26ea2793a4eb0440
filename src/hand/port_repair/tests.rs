//! Tests of repairs that find the same board as at open, another board, or a board that has lost its counts.

use super::*;
use crate::board::OutgoingCommand;
use crate::board::protocol::Command;
use crate::finger::link_handover;
use crate::model::configuration::{Configuration, EndState, TouchElement};
use crate::simulated::{Defect, SimulatedBoard, SimulatedCable, SimulatedFinger};

fn configuration() -> Configuration {
    let mut configuration = Configuration::default();
    configuration.hand.end_state = EndState::Hold;
    (configuration.hand.hold_time_ms, configuration.hand.hold_torque_limit) = (1000, 0.5);
    configuration
}

fn board() -> SimulatedBoard {
    SimulatedBoard::new(&configuration(), &[FingerNumber::ONE]).expect("a board")
}

/// A board after the handshake of open.
fn opened(mut board: SimulatedBoard, keeps_zero: bool) -> (Link<SimulatedCable>, KnownBoard) {
    if !keeps_zero {
        assert!(board.finger(1).expect("finger 1").inject(&Defect::ZeroLost));
    }
    let configuration = configuration();
    let terms = Terms::new(&configuration.hand, &configuration.fingers[0]);
    let mut link = Link::new(SimulatedCable::new(board));
    let (identity, configured) = link.shake_hands(1, &terms, ANSWER).expect("the board answers");
    let zero_valid = configured.status.has(Status::ZERO_VALID);
    assert_eq!(zero_valid, keeps_zero);
    let finger = FingerNumber::ONE;
    (link, KnownBoard { finger, address: 1, terms, identity, zero_valid, has_io: false, restarts: 0 })
}

fn finger(link: &mut Link<SimulatedCable>) -> &mut SimulatedFinger {
    link.transport().board().finger(1).expect("finger 1")
}

fn kind(error: &HandError) -> Option<FaultKind> {
    match error {
        HandError::Faulted { finger: FingerNumber::ONE, fault } => Some(fault.kind),
        _ => None,
    }
}

/// The comparison also ensures that the unique numbers of a hand's boards still differ after a recovery.
#[test]
fn a_board_with_another_number_is_refused_and_gets_no_terms() {
    let (mut link, known) = opened(board(), true);
    known.compare(&mut link).expect("the same board");
    let mut link = Link::new(SimulatedCable::new(board().numbered(7)));
    let error = known.compare(&mut link).expect_err("another board");
    assert_eq!(kind(&error), Some(FaultKind::IdentityChanged), "{error}");
    assert!(!finger(&mut link).status().has(Status::CONFIGURED));
}

#[test]
fn a_board_with_another_firmware_version_is_accepted() {
    let (mut link, mut known) = opened(board(), true);
    known.identity.firmware.0[2] += 1;
    known.compare(&mut link).expect("the firmware version is only information");
    known.identity.gauge_bits -= 1;
    assert_eq!(kind(&known.compare(&mut link).expect_err("other gauges")), Some(FaultKind::IdentityChanged));
}

#[test]
fn only_terms_end_a_hold() {
    let (mut link, mut known) = opened(board(), true);
    let command = Command { enable: true, torques: [1000; 4], ..Command::default() };
    link.send(&[OutgoingCommand { address: 1, sequence: 1, command }]).expect("sent");
    let deadline = link.transport().now() + ANSWER;
    assert!(link.stop(1, deadline).expect("the board answers"));
    known.compare(&mut link).expect("the same board");
    assert!(finger(&mut link).status().has(Status::HOLDING));
    known.configure(&mut link).expect("the same board");
    assert!(!finger(&mut link).status().has(Status::HOLDING));
}

/// Until it restarts, a board that does not keep its zeros continues the counts that it had at open.
#[test]
fn a_board_that_does_not_keep_its_zeros_must_not_have_restarted() {
    let (mut link, mut known) = opened(board(), false);
    known.configure(&mut link).expect("its counts have continued");
    finger(&mut link).reset();
    for attempt in 0..2 {
        // The first attempt has given the board its terms again. The second one must be refused too, because the counts
        // are still lost.
        let error = known.configure(&mut link).expect_err("its counts began again");
        assert_eq!(kind(&error), Some(FaultKind::ZeroLost), "attempt {attempt}: {error}");
    }
    let (mut link, mut known) = opened(board(), true);
    finger(&mut link).reset();
    known.configure(&mut link).expect("it keeps its zeros");
}

/// Even a board that keeps its zeros forgets the readings of its tactile elements when it restarts.
#[test]
fn a_restart_of_a_board_with_tactile_elements_is_counted() {
    let mut touching = configuration();
    let element = TouchElement { position: [0.0; 3], normal: [0.0, 0.0, 1.0], newton_per_count: 0.001, zero: 0 };
    touching.fingers[0].touch.elements = vec![element];
    let board = SimulatedBoard::new(&touching, &[FingerNumber::ONE]).expect("a board");
    let (mut link, mut known) = opened(board, true);
    let mut restarts = |link: &mut Link<SimulatedCable>| {
        let configured = known.configure(link).expect("it keeps its zeros");
        known.restored(configured, StopCounts::default()).restarts
    };
    assert_eq!(restarts(&mut link), 0);
    finger(&mut link).reset();
    assert_eq!((restarts(&mut link), restarts(&mut link)), (1, 1));
}

/// The count of a finger's recoveries must never exceed the count of its repairs, even if the finger faults as soon as
/// the servo takes it. So a repair is counted before the servo gets the finger. If the servo does not take the finger,
/// the count is reduced again.
#[test]
fn a_repair_is_counted_exactly_if_the_servo_can_take_the_finger() {
    let (_servo, repair_end) = link_handover();
    let mut repair = PortRepair::new(PathBuf::new(), 0, false, Vec::new(), repair_end);
    let repairs = [const { AtomicU32::new(0) }; FINGERS];
    let counts = || repairs.each_ref().map(|repairs| repairs.load(Ordering::Acquire));
    let board = RestoredBoard { configured: Configured::default(), stops: StopCounts::default(), restarts: 0 };
    let mut give = |place: usize| {
        let address = place as u8 + 1;
        (repair.give(place, RestoredFinger { address, board }, &repairs[place]), counts())
    };
    assert_eq!(give(1), (true, [0, 1, 0]));
    assert_eq!(give(2), (false, [0, 1, 0]), "finger 2 still waits");
    // The servo has released the link without taking finger 2.
    repair.discard_given(&repairs);
    repair.discard_given(&repairs);
    assert_eq!(counts(), [0, 0, 0]);
}
