//! Planners that are slow or that hang: set points that are interpolated, and set points that expire.

use crate::motion::{Track, configuration, joints, send};
use crate::rig::{Bench, TARGET};
use nalgebra::Vector3;
use std::f64::consts::TAU;
use sun2xp::control::SetPoint;
use sun2xp::finger::{FaultKind, Reference, Replaced, Stage};
use sun2xp::model::InverseKinematics;
use sun2xp::model::configuration::ExpiryReaction;

/// A planner sends a tip on a circle ten times a second.
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
    // Nothing expires twice. A change of the stiffness starts from the pose that is held.
    bench.cycles(1000);
    assert_eq!(bench.report().springs, springs + 1);
    bench
        .mailbox
        .try_send((Replaced::Stiffness, None), |set_point| {
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
    // The time of the call takes precedence, and a path is valid until its end.
    let change = |set_point: &mut SetPoint| {
        set_point.joints = TARGET;
        Ok::<(), ()>(())
    };
    bench.mailbox.try_send((Replaced::Place, Some(2.0)), change).expect("not faulted").expect("admitted");
    bench.cycles(1900);
    send(&bench, &[joints(0.5, [0.3, 0.7, 1.2])]);
    bench.cycles(540);
    assert_eq!(bench.stage(), Stage::Running);
    let fault = bench.faults(FaultKind::SetPointExpired);
    assert!((fault.value - 550.0).abs() < 3.0, "{fault}");
    bench.repair();
    bench.opens();
}
