//! Fingers that the program stops, and their recovery.

use crate::recovery::{fault, faults, one_port, recovers};
use crate::rig::{START, TARGET, close, goes, on_boards, open, three_boards, turn, wait_until};
use sun2xp::finger::FaultKind;
use sun2xp::hand::{Recovering, stop_all};
use sun2xp::model::configuration::OnFault;

#[test]
fn stopped_fingers_of_one_port_recover_one_by_one_while_the_others_move() {
    let _turn = turn();
    let (_board, hand) = one_port();
    for finger in [3, 1] {
        hand.stop(finger).expect("a finger");
        assert_eq!(faults(&hand, finger), FaultKind::FingerStopCall);
    }
    let lost = hand.losses(2).expect("losses");
    hand.send_position(2, TARGET).expect("sent");
    recovers(&hand, 3);
    assert_eq!(fault(&hand, 1), Some(FaultKind::FingerStopCall), "only finger 3 recovers");
    goes(&hand, 2, TARGET);
    goes(&hand, 3, START);
    // A stop that is requested during a recovery stops the finger again after the recovery.
    let recovering = Recovering::begin(&hand, 1).expect("begun");
    hand.stop(1).expect("a finger");
    recovering.reconnect().unwrap_or_else(|error| panic!("{error}"));
    wait_until("recovered and stopped", || hand.report(1).is_ok_and(|report| report.recoveries == 1));
    assert_eq!(faults(&hand, 1), FaultKind::FingerStopCall);
    recovers(&hand, 1);
    goes(&hand, 1, TARGET);
    assert_eq!([1, 2, 3].map(|finger| hand.report(finger).expect("a report").recoveries), [2, 0, 1]);
    let now = hand.losses(2).expect("losses");
    assert!(now.damaged_frames == lost.damaged_frames, "the frames of a recovery damage no other frame: {now:?}");
    assert_eq!(hand.stop(4).expect_err("no such finger").errno(), libc::EINVAL);
    close(hand);
}

/// The servo detects a request to stop in its next cycle. The recovery begins before this cycle.
#[test]
fn a_finger_recovers_right_after_it_was_stopped() {
    let _turn = turn();
    let (_board, hand) = one_port();
    for recoveries in 1..=20 {
        match recoveries % 2 {
            0 => stop_all(),
            _ => hand.stop(2).expect("a finger"),
        }
        recovers(&hand, 2);
        assert_eq!(hand.report(2).expect("a report").recoveries, recoveries, "recovery {recoveries} found no fault");
    }
    close(hand);
}

#[test]
fn a_stopped_finger_stops_the_hand_if_fingers_stop_together() {
    let _turn = turn();
    let boards = three_boards();
    let mut configuration = on_boards(&boards);
    configuration.hand.on_fault = OnFault::Hand;
    let hand = open(configuration);
    hand.stop(2).expect("a finger");
    assert_eq!(faults(&hand, 2), FaultKind::FingerStopCall);
    for finger in [1, 3] {
        assert_eq!(faults(&hand, finger), FaultKind::Companion);
    }
    recovers(&hand, 2);
    goes(&hand, 2, TARGET);
    close(hand);
}
