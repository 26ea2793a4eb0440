//! Planners that are slow or that hang: set points that are interpolated, and set points that expire.

use crate::motion::{Track, configuration, joints, plan, send};
use crate::rig::{Bench, TARGET};
use nalgebra::Vector3;
use std::f64::consts::TAU;
use std::time::Duration;
use sun2xp::control::SetPoint;
use sun2xp::control::motion::PathExtent;
use sun2xp::finger::{Condition, FaultKind, Reaction, Reference, Reflex, Replaced, Stage, Validity};
use sun2xp::model::InverseKinematics;
use sun2xp::model::configuration::ExpiryReaction;

/// Ten times a second, a planner sends the joint angles for a position of the tip on a circle.
#[test]
fn a_slow_stream_of_set_points_becomes_smooth_motion() {
    let mut bench = Bench::with(|configuration| configuration.fingers[0].motion.interpolate_ms = Some(100.0));
    let finger = &configuration().fingers[0];
    let links = finger.links();
    let inverse = InverseKinematics::new(links, finger.joint_limits());
    let centre = links.tip(&TARGET) - Vector3::x();
    bench.goes(TARGET);
    let mut present = TARGET;
    let mut track = Track(Vec::new());
    for step in 1..=40 {
        let (sin, cos) = (f64::from(step) * 0.1 * TAU).sin_cos();
        present = inverse.joints(&(centre + Vector3::new(cos, sin, 0.0)), &present).expect("within reach");
        bench.mailbox.send(|set_point| set_point.joints = present).expect("not faulted");
        track.run(&mut bench, 100);
    }
    let tips = |reference: &Reference| links.jacobian(&reference.joints) * reference.motion.rates;
    let steady = &track.0[1000..];
    let mean = steady.iter().map(|reference| tips(reference).norm()).sum::<f64>() / steady.len() as f64;
    let jump = steady.windows(2).map(|pair| (tips(&pair[1]) - tips(&pair[0])).norm()).fold(0.0, f64::max);
    let ripple = steady.iter().map(|reference| (tips(reference).norm() - mean).abs()).fold(0.0, f64::max);
    println!("mean {mean:.3} cm/s, jump {:.2} %, ripple {:.2} %", 100.0 * jump / mean, 100.0 * ripple / mean);
    // The joint angles are interpolated, so the tip's speed varies a little along the circle.
    assert!(mean > 5.0 && jump < 0.05 * mean && ripple < 0.15 * mean, "{mean} {jump} {ripple}");
    track.is_smooth([0.02, 2.0, 6000.0]);
}

#[test]
fn a_set_point_that_replaces_a_path_causes_no_jump_with_interpolation_either() {
    let mut bench = Bench::with(|configuration| configuration.fingers[0].motion.interpolate_ms = Some(100.0));
    bench.goes(TARGET);
    let mut track = Track(Vec::new());
    send(&bench, &[joints(1.0, [-0.3, 1.1, 0.8])]);
    track.run(&mut bench, 500);
    assert!(track.0[499].motion.rates.amax() > 0.5, "{:?}", track.0[499]);
    bench.mailbox.send(|set_point| set_point.joints = TARGET).expect("not faulted");
    track.run(&mut bench, 1500);
    track.is_smooth([0.05, 10.0, 6000.0]);
    assert!((track.0[1999].joints - TARGET).amax() < 1e-3, "{:?}", track.0[1999]);
}

#[test]
fn an_expired_set_point_leaves_the_finger_where_it_is() {
    let mut bench = Bench::with(|configuration| configuration.fingers[0].motion.valid_ms = Some(300.0));
    // Nothing expires before a planner has sent anything.
    bench.cycles(500);
    let springs = bench.report().springs;
    // The push keeps the finger away from its set point.
    bench.mailbox.send(|set_point| set_point.joints = TARGET).expect("not faulted");
    bench.with_finger(|finger| finger.plant().set_external_force(Vector3::new(0.0, 1.5, 0.0)));
    bench.cycles(299);
    assert_eq!(bench.report().springs, springs);
    bench.cycles(2);
    let held = bench.report().set_point;
    assert_eq!(bench.report().springs, springs + 1);
    let away = (bench.report().cycle.joints - TARGET).amax();
    assert!(away > 0.05 && (held.joints - bench.report().cycle.joints).amax() < 0.01, "{away} {held:?}");
    assert_eq!(held.stiffness[(0, 0)], 1.0);
    // A set point expires only once. A change of the stiffness starts from the pose that is held.
    bench.cycles(1000);
    assert_eq!(bench.report().springs, springs + 1);
    bench
        .mailbox
        .try_send((Replaced::Stiffness, Validity::default()), |set_point| {
            set_point.stiffness *= 2.0;
            Ok::<(), ()>(())
        })
        .expect("not faulted")
        .expect("admitted");
    bench.cycles(1);
    assert_eq!((bench.report().set_point.joints, bench.report().set_point.stiffness[(0, 0)]), (held.joints, 2.0));
}

#[test]
fn a_set_point_that_expires_can_stop_the_finger() {
    let mut bench = Bench::with(|configuration| {
        configuration.fingers[0].motion.valid_ms = Some(50.0);
        configuration.fingers[0].motion.on_expiry = ExpiryReaction::EndState;
    });
    // The validity in the call takes precedence over the configured one. The validity of a path counts from its end.
    let change = |set_point: &mut SetPoint| {
        set_point.joints = TARGET;
        Ok::<(), ()>(())
    };
    bench
        .mailbox
        .try_send((Replaced::Place, Validity::hold_after(Some(Duration::from_secs(2)))), change)
        .expect("not faulted")
        .expect("admitted");
    bench.cycles(1900);
    send(&bench, &[joints(0.5, [0.3, 0.7, 1.2])]);
    bench.cycles(540);
    assert_eq!(bench.stage(), Stage::Running);
    let fault = bench.faults(FaultKind::SetPointExpired);
    assert!((fault.value - 550.0).abs() < 3.0, "{fault}");
    bench.repair();
    bench.opens();
}

/// Moves the set point to [`TARGET`].
fn to_target(set_point: &mut SetPoint) -> Result<(), ()> {
    set_point.joints = TARGET;
    Ok(())
}

/// A validity in milliseconds. A millisecond is one period, because the finger runs at 1000 Hz.
fn validity(hold: u64, end: u64) -> Validity {
    let [hold_after, end_after] = [hold, end].map(|time| Some(Duration::from_millis(time)));
    Validity { hold_after, end_after, since: None }
}

#[test]
fn a_finger_that_holds_its_pose_for_too_long_stops() {
    let mut bench = Bench::with(|configuration| {
        configuration.fingers[0].motion.valid_ms = Some(50.0);
        configuration.fingers[0].motion.end_state_ms = Some(200.0);
    });
    let springs = bench.report().springs;
    bench.mailbox.send(|set_point| set_point.joints = TARGET).expect("not faulted");
    bench.cycles(52);
    assert!(bench.report().expired && bench.report().springs == springs + 1);
    bench.cycles(190);
    // A command in this time makes the finger follow again.
    bench.mailbox.send(|set_point| set_point.joints = TARGET).expect("not faulted");
    bench.cycles(1);
    assert!(!bench.report().expired);
    bench.cycles(247);
    assert_eq!(bench.stage(), Stage::Running);
    let fault = bench.faults(FaultKind::SetPointExpired);
    assert!((fault.value - 250.0).abs() < 3.0, "{fault}");
}

#[test]
fn a_renewed_set_point_does_not_expire() {
    let mut bench = Bench::new();
    let springs = bench.report().springs;
    bench.mailbox.try_send((Replaced::Place, validity(100, 1000)), to_target).expect("not faulted").expect("admitted");
    for _ in 0..100 {
        bench.cycles(25);
        bench.mailbox.keep_valid(validity(100, 1000)).expect("not faulted");
    }
    assert_eq!((bench.report().springs, bench.report().expired), (springs, false));
    // The renewals end. The finger holds its pose, and then stops.
    bench.cycles(100);
    assert!(!bench.report().expired);
    bench.cycles(2);
    assert!(bench.report().expired);
    // A renewal does not bring the set point back, but it delays the end state.
    bench.mailbox.keep_valid(validity(100, 1000)).expect("not faulted");
    bench.cycles(998);
    assert_eq!((bench.stage(), bench.report().springs), (Stage::Running, springs + 1));
    let fault = bench.faults(FaultKind::SetPointExpired);
    assert!((fault.value - 1000.0).abs() < 3.0, "{fault}");
}

#[test]
fn a_delayed_renewal_does_not_prolong_the_validity() {
    let mut bench = Bench::new();
    bench.cycles(300);
    let late = |bench: &Bench, cycles: u64| {
        let since = Some(bench.report().last - cycles * 1_000_000);
        bench.mailbox.keep_valid(Validity { since, ..validity(100, 150) }).expect("not faulted");
    };
    bench.mailbox.try_send((Replaced::Place, validity(100, 1000)), to_target).expect("not faulted").expect("admitted");
    bench.cycles(50);
    late(&bench, 60);
    bench.cycles(38);
    assert!(!bench.report().expired);
    bench.cycles(4);
    assert!(bench.report().expired, "the validity has ended 100 ms after its beginning");
    late(&bench, 200);
    bench.cycles(3);
    assert!(matches!(bench.stage(), Stage::Faulted(_)), "the end was before the renewal arrived");
}

#[test]
fn a_renewal_limits_a_path_and_a_later_set_point_ends_it() {
    let mut bench = Bench::new();
    bench.goes(TARGET);
    send(&bench, &[joints(5.0, [0.3, 0.7, 1.2])]);
    // The planner sends the path and the renewal before the servo takes either of them.
    bench.mailbox.keep_valid(validity(100, 1000)).expect("not faulted");
    bench.cycles(102);
    assert!(bench.report().expired, "the validity counts from the renewal, and not from the end of the path");
    // A set point after a renewal has its own validity, which is without end here.
    bench.mailbox.keep_valid(validity(100, 200)).expect("not faulted");
    bench.mailbox.send(|set_point| set_point.joints = TARGET).expect("not faulted");
    bench.cycles(300);
    assert_eq!((bench.stage(), bench.report().expired), (Stage::Running, false));
}

#[test]
fn a_finger_without_a_command_can_stop_after_a_time_too() {
    let mut bench = Bench::new();
    let springs = bench.report().springs;
    let end_after = Some(Duration::from_millis(300));
    bench.mailbox.keep_valid(Validity { end_after, ..Validity::default() }).expect("not faulted");
    bench.cycles(299);
    assert_eq!((bench.stage(), bench.report().springs), (Stage::Running, springs));
    bench.faults(FaultKind::SetPointExpired);
}

/// The numbers of set points that are discarded during an inhibition are used again for later set points.
#[test]
fn a_renewal_of_a_discarded_set_point_does_not_shorten_a_later_validity() {
    let mut bench = Bench::new();
    bench.goes(TARGET);
    let (condition, reaction) = (Condition::JointAbove { joint: 2, angle: 0.5 }, Reaction::Hold);
    let reflex = Reflex { condition, reaction, priority: 0, refractory: 0.0, inhibition: 0.05 };
    bench.reflexes.install(reflex).expect("a place");
    bench.cycles(2);
    let send = |bench: &Bench, validity| {
        bench.mailbox.try_send((Replaced::Place, validity), to_target).expect("not faulted").expect("admitted");
    };
    send(&bench, validity(100, 10_000));
    bench.mailbox.keep_valid(validity(100, 10_000)).expect("not faulted");
    bench.cycles(200);
    send(&bench, validity(5000, 10_000));
    bench.cycles(1000);
    assert!(!bench.report().expired);
    assert_eq!(bench.report().set_point.joints, TARGET);
}

/// Returns a finger whose reflex has just fired, with an inhibition of `inhibition`, s. The set point that the planner
/// has sent before is valid for 100 ms.
fn held_by_a_reflex(inhibition: f64) -> Bench {
    let mut bench = Bench::new();
    bench.goes(TARGET);
    bench.mailbox.try_send((Replaced::Place, validity(100, 5000)), to_target).expect("not faulted").expect("admitted");
    let (condition, reaction) = (Condition::JointAbove { joint: 2, angle: 0.5 }, Reaction::Hold);
    let reflex = Reflex { condition, reaction, priority: 0, refractory: 0.0, inhibition };
    bench.reflexes.install(reflex).expect("a place");
    bench.cycles(2);
    bench
}

#[test]
fn a_planner_that_a_reflex_inhibits_is_not_silent() {
    let mut bench = held_by_a_reflex(0.5);
    for _ in 0..100 {
        bench.cycles(10);
        let sent = bench.mailbox.try_send((Replaced::Place, validity(100, 200)), to_target);
        sent.expect("not faulted").expect("admitted");
        assert_eq!((bench.stage(), bench.report().expired), (Stage::Running, false));
    }
}

/// The path would last 2 s. The planner sends nothing after the path.
#[test]
fn a_path_that_a_reflex_inhibits_keeps_its_validity() {
    let mut bench = held_by_a_reflex(0.3);
    let report = bench.report();
    let path = plan(&report.reference, &[joints(2.0, [0.3, 0.7, 1.2])]);
    let valid = (report.springs, report.reference.period, validity(100, 5000));
    let change = |set_point: &mut SetPoint| to_target(set_point).map(|()| PathExtent::default());
    let sent = bench.mailbox.send_path(valid, &path.table(), change);
    assert!(matches!(sent, Ok(Ok(Some(_)))), "{sent:?}");
    bench.cycles(2050);
    assert!(!bench.report().expired);
    bench.cycles(100);
    assert!(bench.report().expired);
}

/// The finger did not follow the set point during the inhibition, and does not follow it later either.
#[test]
fn a_set_point_that_was_discarded_before_an_expiry_stays_discarded() {
    let mut bench = held_by_a_reflex(0.3);
    let sent = bench.mailbox.try_send((Replaced::Place, validity(100, 5000)), |set_point| {
        set_point.joints = TARGET + Vector3::new(0.1, 0.1, 0.1);
        Ok::<(), ()>(())
    });
    sent.expect("not faulted").expect("admitted");
    bench.cycles(400);
    let held = bench.report();
    assert!(held.expired);
    bench.mailbox.send(|set_point| set_point.stiffness *= 2.0).expect("not faulted");
    bench.cycles(2);
    let report = bench.report();
    assert_eq!(report.set_point.joints, held.set_point.joints);
    assert_eq!(report.set_point.stiffness, held.set_point.stiffness * 2.0);
}
