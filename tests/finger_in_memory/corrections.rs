//! The library corrects the last set point. A correction does not change the validity of the set point.

use crate::rig::{Bench, TARGET};
use nalgebra::Vector3;
use std::time::Duration;
use sun2xp::control::SetPoint;
use sun2xp::finger::{Replaced, Validity};

/// A validity of 100 periods.
const VALID: Validity = Validity { hold_after: Some(Duration::from_millis(100)), end_after: None, since: None };

fn send(bench: &Bench) {
    let to_target = |set_point: &mut SetPoint| {
        set_point.joints = TARGET;
        Ok::<(), ()>(())
    };
    bench.mailbox.try_send((Replaced::Place, VALID), to_target).expect("not faulted").expect("admitted");
}

/// Moves the last set point by 0.01 rad, and returns its joint angles.
fn correct(bench: &Bench) -> Vector3<f64> {
    let sent = bench.mailbox.sent();
    let corrected = SetPoint { joints: sent.joints - Vector3::repeat(0.01), ..sent };
    bench.mailbox.correct(Replaced::Place, &sent, corrected).expect("not faulted");
    corrected.joints
}

#[test]
fn a_corrected_set_point_expires_with_the_set_point_of_the_planner() {
    let mut bench = Bench::new();
    send(&bench);
    for _ in 0..9 {
        bench.cycles(10);
        let joints = correct(&bench);
        bench.cycles(1);
        assert_eq!((bench.report().set_point.joints, bench.report().expired), (joints, false));
    }
    bench.cycles(4);
    assert!(bench.report().expired, "the set point was sent 103 periods ago");
    // A correction of the held pose is not a command of a planner, so the set point stays expired.
    correct(&bench);
    bench.cycles(10);
    assert!(bench.report().expired);
    send(&bench);
    bench.cycles(90);
    assert!(!bench.report().expired);
    bench.cycles(20);
    assert!(bench.report().expired);
}

#[test]
fn a_correction_before_the_servo_takes_a_set_point_keeps_its_validity() {
    let mut bench = Bench::new();
    send(&bench);
    correct(&bench);
    bench.cycles(90);
    assert!(!bench.report().expired);
    bench.cycles(20);
    assert!(bench.report().expired);
}

#[test]
fn a_corrected_set_point_can_be_renewed() {
    let mut bench = Bench::new();
    send(&bench);
    bench.cycles(50);
    // The servo takes the renewal and the correction in the same cycle.
    bench.mailbox.keep_valid(VALID).expect("not faulted");
    correct(&bench);
    bench.cycles(90);
    assert!(!bench.report().expired);
    bench.mailbox.keep_valid(VALID).expect("not faulted");
    bench.cycles(90);
    assert!(!bench.report().expired);
    bench.cycles(20);
    assert!(bench.report().expired);
}

/// In each round, a set point expires, and a correction is made in the cycle of the expiry. With each round, the
/// correction comes one reading of the servo's clock later in this cycle. If it comes after the servo has taken its
/// input and before the servo has published its report, it is a correction of the expired set point.
#[test]
fn a_correction_does_not_undo_an_expiry() {
    let mut bench = Bench::new();
    for readings in 0.. {
        send(&bench);
        bench.cycles(100);
        assert!(!bench.report().expired);
        bench.correct_after(readings);
        bench.cycles(1);
        let (held, corrected) = (bench.report(), bench.corrected());
        assert!(held.expired && held.set_point.joints != TARGET, "{readings}");
        bench.cycles(10);
        let report = bench.report();
        assert_eq!((report.expired, report.set_point.joints), (true, held.set_point.joints), "{readings}");
        if !corrected {
            assert!(readings > 2, "the servo reads the clock several times in a cycle");
            break;
        }
    }
}
