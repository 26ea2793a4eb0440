//! What the desk does with the Targets of owners, without a network. The tests wait for the servos of a simulated hand.

#[path = "desk/rig.rs"]
mod rig;

use rig::{FAR, Rig, STIFF, is_near, joints, kept, path};
use sun2xp::Stage;
use sun2xp::realtime::now;
use sun2xp_remote_protocol::{Code, Part};
use sun2xp_serve::goal::Destination;

#[test]
fn a_path_of_a_stopped_finger_holds_back_the_whole_target() {
    let mut rig = Rig::new("");
    rig.acquire("alice");
    rig.hand.stop(1).expect("finger 1");
    rig.wait_until("stop", &[], |rig| matches!(rig.report(1).stage, Stage::Faulted(_)));
    let before = rig.report(2).set_point_number;
    let refused = rig.send(&[path(1, 1, 1.0, FAR), joints(2, 1, FAR)]).expect("a refusal");
    assert_eq!(refused.code, Code::Stopped, "{refused:?}");
    let cycles = rig.report(2).losses.cycles;
    rig.wait_until("cycles", &[], |rig| rig.report(2).losses.cycles > cycles + 20);
    assert_eq!(rig.report(2).set_point_number, before);
    assert_eq!(rig.desk.goals()[1].command, 0);
}

#[test]
fn a_part_with_a_path_and_a_stiffness_is_applied_as_a_whole() {
    let mut rig = Rig::new("catch_ms = 10000\nend_ms = 60000");
    rig.acquire("alice");
    let parts = [Part { stiffness: Some(STIFF), ..path(1, 1, 20.0, FAR) }, joints(2, 1, FAR)];
    let before = rig.report(2).set_point_number;
    assert_eq!(rig.send(&parts), None);
    assert!(rig.desk.goals()[..2].iter().all(|goal| goal.command == 1));
    rig.wait_until("path", &parts, |rig| rig.report(1).set_point.motion.is_some());
    assert_eq!(rig.report(1).set_point.stiffness[(0, 0)], STIFF[0][0]);
    rig.wait_until("set point", &parts, |rig| rig.report(2).set_point_number > before);
    // The path of finger 2 is refused, so the Kx of finger 1 stays.
    let soft = Part { stiffness: Some([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]), ..kept(1, 2) };
    let refused = rig.send(&[soft, path(2, 2, 1.0, [9.0, 0.5, 0.9])]).expect("a refusal");
    assert_eq!(refused.code, Code::Argument, "{refused:?}");
    let cycles = rig.report(1).losses.cycles;
    rig.wait_until("cycles", &parts, |rig| rig.report(1).losses.cycles > cycles + 20);
    assert_eq!(rig.report(1).set_point.stiffness[(0, 0)], STIFF[0][0]);
}

/// At both limits of a joint, the hand tolerates the error that rounding to `float` causes at the larger limit. At the
/// lower limit of joint 2, 5 degrees, this tolerance is more than the rounding error of the lower limit itself.
#[test]
fn the_lead_bounds_the_force_toward_a_limit_that_was_rounded() {
    let mut rig = Rig::new("lead_force = 1.0");
    rig.acquire("alice");
    let limits = rig.hand.limits(1).expect("finger 1");
    let (low, high) = (limits.joint_minimum[2], limits.joint_maximum[2]);
    let rounding = f64::from(f32::EPSILON) * high;
    assert!(rounding > 2.0 * f64::from(f32::EPSILON) * low);
    let start = rig.report(1).set_point.joints;
    let place = [start[0], start[1], low - rounding / 2.0];
    let number = rig.report(1).set_point_number;
    assert_eq!(rig.send(&[joints(1, 1, place)]), None);
    let first = rig.wait_for("set point", |rig| Some(rig.report(1)).filter(|report| report.set_point_number > number));
    assert!(first.set_point.joints[2] > low + 0.05, "{} is ahead by the lead only", first.set_point.joints);
    rig.wait_until("set point at the limit", &[joints(1, 1, place)], |rig| rig.report(1).set_point.joints[2] == low);
}

/// The owner commands Kx only. A push moves the finger away from where it was caught.
#[test]
fn a_stiffness_that_is_restored_after_a_catch_pulls_with_the_force_of_the_lead_only() {
    let mut rig = Rig::new("lead_force = 1.0");
    rig.acquire("alice");
    let stiff = Part { stiffness: Some(STIFF), ..kept(1, 1) };
    rig.wait_until("stiffness", std::slice::from_ref(&stiff), |rig| {
        rig.report(1).set_point.stiffness[(0, 0)] == STIFF[0][0]
    });
    rig.wait_in_silence("catch", |rig| rig.report(1).expired);
    let caught = rig.report(1).set_point.joints;
    rig.hand.push_simulated(1, [2.0, 2.0, 0.0]).expect("pushed");
    rig.wait_in_silence("push", |rig| (rig.report(1).cycle.joints - caught).amax() > 0.2);
    assert_eq!(rig.send(&[stiff]), None);
    let report = rig.wait_for("stiffness", |rig| {
        let report = rig.report(1);
        (!report.expired).then_some(report)
    });
    assert_eq!(report.set_point.stiffness[(0, 0)], STIFF[0][0]);
    assert!(!is_near(&report.set_point.joints, &caught, 0.05), "the set point is ahead of the finger by the lead only");
}

/// The owner commands Kx only. Something pushes the finger away before it is caught, and lets it go afterwards.
#[test]
fn a_finger_whose_place_is_kept_returns_to_its_set_point_after_a_catch() {
    let mut rig = Rig::new("end_ms = 20000");
    rig.acquire("alice");
    let before = rig.report(1).set_point.joints;
    let kx = [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]];
    let part = [Part { stiffness: Some(kx), ..kept(1, 1) }];
    rig.wait_until("stiffness", &part, |rig| rig.report(1).set_point.stiffness[(0, 0)] == 2.0);
    rig.hand.push_simulated(1, [2.0, 2.0, 0.0]).expect("pushed");
    rig.wait_until("push", &part, |rig| !is_near(&rig.report(1).cycle.joints, &before, 0.05));
    rig.wait_in_silence("catch", |rig| rig.report(1).expired);
    rig.hand.push_simulated(1, [0.0; 3]).expect("released");
    rig.wait_until("return", &part, |rig| {
        let report = rig.report(1);
        !report.expired && is_near(&report.set_point.joints, &before, 0.01)
    });
}

/// The new owner commands a place only. The stiffness is that from before the catch.
#[test]
fn a_new_owner_does_not_get_the_soft_stiffness_of_a_catch() {
    let mut rig = Rig::new("end_ms = 20000");
    rig.acquire("alice");
    let stiff = [Part { stiffness: Some(STIFF), ..joints(1, 1, FAR) }];
    rig.wait_until("stiffness", &stiff, |rig| rig.report(1).set_point.stiffness[(0, 0)] == STIFF[0][0]);
    rig.wait_in_silence("catch", |rig| rig.report(1).expired);
    rig.acquire("bob");
    let report = rig.wait_for("set point", |rig| {
        rig.send(&[joints(1, 1, FAR)]);
        let (in_force, report) = rig.hand.newest_in_force(1).expect("a report");
        (in_force && !report.expired).then_some(report)
    });
    assert_eq!(report.set_point.stiffness[(0, 0)], STIFF[0][0]);
}

/// An acquire counts as a Target.
#[test]
fn a_caught_finger_follows_its_set_point_again_when_a_new_owner_acquires() {
    let mut rig = Rig::new("end_ms = 20000");
    rig.acquire("alice");
    let start = rig.report(1).cycle.joints;
    let place = [start[0] + 0.05, start[1], start[2]];
    let is_there = |rig: &Rig| is_near(&rig.report(1).set_point.joints, &place.into(), 1e-6);
    rig.wait_until("set point", &[joints(1, 1, place)], is_there);
    rig.wait_in_silence("catch", |rig| rig.report(1).expired);
    rig.acquire("bob");
    rig.wait_in_silence("set point", |rig| !rig.report(1).expired && is_there(rig));
    rig.desk.look(now());
    let before = rig.desk.counts().caught;
    rig.wait_until("set point", &[joints(2, 1, FAR)], |rig| rig.report(2).set_point_number > 0);
    rig.wait_in_silence("count of the next catch", |rig| rig.desk.counts().caught > before);
}

/// The desk receives no Target while the finger recovers. The next Target has a new part without a place.
#[test]
fn a_recovered_finger_does_not_return_to_its_earlier_place() {
    let mut rig = Rig::new("end_ms = 20000");
    rig.acquire("alice");
    rig.wait_until("set point", &[joints(1, 1, FAR)], |rig| rig.report(1).set_point_number > 0);
    rig.hand.stop(1).expect("finger 1");
    rig.hand.recover(1).expect("recovered");
    let held = rig.report(1).set_point.joints;
    let stiff = [Part { stiffness: Some(STIFF), ..kept(1, 2) }];
    rig.wait_until("stiffness", &stiff, |rig| rig.report(1).set_point.stiffness[(0, 0)] == STIFF[0][0]);
    assert!(is_near(&rig.report(1).set_point.joints, &held, 1e-3));
}

/// The Targets come faster than the servos take their parts.
#[test]
fn parts_for_which_a_servo_has_no_room_are_applied_later() {
    let mut rig = Rig::new("end_ms = 20000");
    rig.acquire("alice");
    let parts = |command| [1, 2].map(|finger| Part { damping: Some(1.0), ..kept(finger, command) });
    for command in 1..=200 {
        assert_eq!(rig.send(&parts(command)), None);
    }
    rig.wait_until("last parts", &parts(200), |rig| rig.desk.goals()[..2].iter().all(|goal| goal.command == 200));
    assert_eq!(rig.desk.counts().refused, 0);
}

#[test]
fn a_caught_finger_waits_while_an_acquire_recovers_another_one() {
    let mut rig = Rig::new("end_ms = 300");
    rig.acquire("alice");
    rig.wait_until("set point", &[joints(2, 1, FAR)], |rig| rig.report(2).set_point_number > 0);
    rig.wait_in_silence("catch", |rig| rig.report(2).expired);
    // The server calls `Desk::begin` only when the fingers have recovered.
    rig.acquire_only("bob");
    let cycles = rig.report(2).losses.cycles;
    rig.wait_in_silence("cycles", |rig| rig.report(2).losses.cycles > cycles + 600);
    assert_eq!(rig.report(2).stage, Stage::Running);
}

#[test]
fn a_path_ends_as_soon_as_another_client_acquires() {
    // A pause of the machine must not catch the finger, because a caught finger drops its path.
    let mut rig = Rig::new("catch_ms = 10000\nend_ms = 60000");
    rig.acquire("alice");
    rig.wait_until("path", &[path(2, 1, 30.0, FAR)], |rig| rig.report(2).set_point_number > 0);
    let number = rig.report(2).set_point_number;
    rig.acquire_only("bob");
    rig.wait_in_silence("end of the path", |rig| rig.report(2).set_point_number > number);
    assert!(!is_near(&rig.report(2).set_point.joints, &FAR.into(), 0.05));
}

#[test]
fn the_end_of_a_path_is_a_set_point_to_which_a_caught_finger_returns() {
    let mut rig = Rig::new("");
    rig.acquire("alice");
    let start = rig.report(1).cycle.joints;
    let end = [start[0] + 0.1, start[1], start[2]];
    let way = [path(1, 1, 0.2, end)];
    rig.wait_until("end of the path", &way, |rig| matches!(rig.desk.goals()[0].destination, Destination::Joints(_)));
    rig.wait_in_silence("catch", |rig| rig.report(1).expired);
    rig.hand.push_simulated(1, [0.0, 0.5, 0.0]).expect("pushed");
    rig.wait_in_silence("push", |rig| !is_near(&rig.report(1).cycle.joints, &end.into(), 0.03));
    rig.hand.push_simulated(1, [0.0; 3]).expect("released");
    rig.wait_until("return", &way, |rig| {
        !rig.report(1).expired && is_near(&rig.report(1).set_point.joints, &end.into(), 1e-6)
    });
}

#[test]
fn a_finger_that_is_being_recovered_takes_nothing() {
    let mut rig = Rig::new("end_ms = 20000");
    rig.acquire("alice");
    rig.hand.stop(1).expect("finger 1");
    let hand = rig.hand.clone();
    let recovering = std::thread::spawn(move || hand.recover(1));
    rig.wait_until("recovery", &[], |rig| rig.report(1).stage == Stage::Opening);
    let now = rig.report(1).cycle.joints;
    let refused = rig.send(&[joints(1, 1, [now[0] + 0.02, now[1], now[2]])]);
    // On a busy machine the recovery may have ended already.
    if rig.report(1).stage == Stage::Opening {
        assert_eq!(refused.map(|answer| answer.code), Some(Code::InProgress));
        assert_eq!(rig.desk.goals()[0].command, 0);
    }
    recovering.join().expect("no panic").expect("recovered");
}

#[test]
fn a_stop_before_a_recovery_is_carried_out_after_it() {
    let mut rig = Rig::new("end_ms = 20000");
    rig.acquire("alice");
    let stops = rig.desk.stops();
    assert!(rig.desk.stop_again(&stops).is_ok());
    rig.desk.stop(Some(1)).expect("finger 1");
    rig.hand.recover(1).expect("recovered, because it began after the stop");
    assert_eq!(rig.report(1).stage, Stage::Running);
    rig.desk.stop_again(&stops).expect_err("finger 1 was stopped meanwhile");
    rig.wait_in_silence("stop", |rig| matches!(rig.report(1).stage, Stage::Faulted(_)));
    assert_eq!(rig.report(2).stage, Stage::Running);
    let stops = rig.desk.stops();
    rig.desk.release();
    assert!(rig.desk.stop_again(&stops).is_err(), "the end of an ownership stops every finger");
}
