//! Zeroing a finger at a pose: while its sensors are read, the finger is held as before. If the zeroing is refused, the
//! finger remains the same spring.

use crate::motion::{joints, send};
use crate::rig::{Bench, TARGET};
use nalgebra::Vector3;
use sun2xp::calibration::{Calibration, Findings, Obstacle, Task, Verdict};
use sun2xp::finger::{Adjustable, CalibrationRun, FaultKind, Order, Stage};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, Scheme, ZeroingMethod};

fn configuration(scheme: Scheme) -> Configuration {
    let mut configuration = Configuration::default();
    let finger = &mut configuration.fingers[0];
    finger.port = "in memory".into();
    finger.gauge.zero = [220.0; 4];
    finger.controller.scheme = Some(scheme);
    finger.zeroing.method = Some(ZeroingMethod::Pose);
    finger.zeroing.pose_degrees = TARGET.map(f64::to_degrees).into();
    configuration
}

/// A finger at rest at [`TARGET`].
fn standing(scheme: Scheme) -> Bench {
    let mut bench = Bench::with(|is| *is = configuration(scheme));
    bench.goes(TARGET);
    bench
}

fn order(bench: &Bench, scheme: Scheme) {
    order_task(bench, scheme, Task::Zero);
}

fn order_task(bench: &Bench, scheme: Scheme, task: Task) {
    let mut configuration = configuration(scheme);
    let rate = configuration.hand.rate;
    let calibration = Calibration::new(task, &configuration.fingers[0], rate).expect("usable");
    configuration.fingers[0] = Calibration::controlled(&configuration.fingers[0], rate);
    let mut adjustable = Adjustable::new(&configuration, FingerNumber::ONE).expect("usable");
    adjustable.number = 1;
    let run = CalibrationRun { calibration, adjustable };
    bench.mailbox.order(Order::Calibrate(run)).expect("not faulted").expect("idle");
}

fn verdict(bench: &mut Bench) -> Verdict {
    bench.cycles(1);
    bench.until("calibrated", |bench| bench.stage() != Stage::Calibrating);
    bench.report().calibration.expect("a verdict")
}

#[test]
fn a_finger_that_stands_still_is_zeroed() {
    for scheme in [Scheme::StateFeedback, Scheme::Figure10] {
        let mut bench = standing(scheme);
        let off = bench.with_finger(|finger| finger.plant().joints()) - TARGET;
        order(&bench, scheme);
        let Verdict::Found(Findings::Zeros(zeros)) = verdict(&mut bench) else { panic!("{:?}", bench.report()) };
        // The controller's joint angles were correct, so the reported error is the finger's distance from the pose.
        assert!((zeros.joint_error - off).amax() < 0.005, "{scheme:?}: {zeros:?}, {off}");
        assert_eq!(bench.stage(), Stage::Limp);
    }
}

#[test]
fn a_zeroing_during_a_push_is_refused_and_the_finger_stays_the_spring_that_it_was() {
    for scheme in [Scheme::StateFeedback, Scheme::Figure10] {
        let mut bench = standing(scheme);
        let before = bench.report().set_point;
        order(&bench, scheme);
        bench.cycles(100);
        let push =
            |force| move |finger: &mut sun2xp::simulated::SimulatedFinger| finger.plant().set_external_force(force);
        bench.with_finger(push(Vector3::new(1.0, 0.0, 0.0)));
        // A set point sent during the calibration has no effect, neither now nor later.
        bench.mailbox.send(|set_point| set_point.joints = Vector3::new(0.0, 0.5, 0.5)).expect("not faulted");
        let refused = verdict(&mut bench);
        assert!(matches!(refused, Verdict::Refused(Obstacle::Moved { .. })), "{scheme:?}: {refused:?}");
        assert_eq!((bench.stage(), bench.report().set_point), (Stage::Running, before));
        bench.mailbox.send(|set_point| set_point.damping = 1.1).expect("not faulted");
        bench.with_finger(push(Vector3::zeros()));
        bench.cycles(1000);
        let report = bench.report();
        assert_eq!((report.set_point.joints, report.set_point.damping), (TARGET, 1.1));
        assert!((report.cycle.joints - TARGET).amax() < 0.03, "{report:?}");
        // The finger accepts another order.
        order(&bench, scheme);
        assert!(matches!(verdict(&mut bench), Verdict::Found(_)));
    }
}

#[test]
fn a_set_point_sent_in_the_previous_cycle_counts_as_motion() {
    let mut bench = standing(Scheme::StateFeedback);
    bench.mailbox.send(|set_point| set_point.joints.x += 0.2).expect("not faulted");
    order(&bench, Scheme::StateFeedback);
    let refused = verdict(&mut bench);
    assert!(matches!(refused, Verdict::Refused(Obstacle::Moved { joint: 0, .. })), "{refused:?}");
}

#[test]
fn an_adjustment_during_a_calibration_that_is_refused_is_in_force_afterwards() {
    let mut bench = standing(Scheme::StateFeedback);
    order(&bench, Scheme::StateFeedback);
    bench.cycles(50);
    let mut adjusted = Adjustable::new(&configuration(Scheme::Figure10), FingerNumber::ONE).expect("usable");
    adjusted.number = 2;
    bench.mailbox.adjust(adjusted).expect("not faulted");
    bench.with_finger(|finger| finger.plant().set_external_force(Vector3::new(1.0, 0.0, 0.0)));
    assert!(matches!(verdict(&mut bench), Verdict::Refused(Obstacle::Moved { .. })));
    bench.with_finger(|finger| finger.plant().set_external_force(Vector3::zeros()));
    bench.cycles(1000);
    let report = bench.report();
    assert_eq!((report.stage, report.controller), (Stage::Running, 2));
    assert!((report.cycle.joints - TARGET).amax() < 0.03, "{report:?}");
}

/// The routine finds the finger in motion, so the calibration is refused. The finger then holds the set point that was
/// in force when the calibration began.
#[test]
fn a_path_ends_where_a_calibration_began() {
    for interpolate_ms in [None, Some(100.0)] {
        let mut interpolated = configuration(Scheme::StateFeedback);
        interpolated.fingers[0].motion.interpolate_ms = interpolate_ms;
        let mut bench = Bench::with(|is| *is = interpolated);
        bench.goes(TARGET);
        send(&bench, &[joints(1.0, [0.5, 0.9, 1.4])]);
        bench.cycles(500);
        let begun = bench.report().set_point.joints;
        assert!((begun - TARGET).amax() > 0.1, "the finger must be on its way: {begun}");
        order(&bench, Scheme::StateFeedback);
        bench.cycles(1);
        assert_eq!(bench.report().set_point.motion, None, "the motion must not be fed forward");
        let refused = verdict(&mut bench);
        assert!(matches!(refused, Verdict::Refused(Obstacle::Moved { .. })), "{refused:?}");
        bench.cycles(1000);
        let report = bench.report();
        assert_eq!((report.stage, report.set_point.joints), (Stage::Running, begun), "{interpolate_ms:?}");
    }
}

/// After a calibration that lasts longer than the time that a black box keeps, the servo resumes a controller that no
/// kept record names.
#[test]
fn the_black_box_keeps_the_controller_that_is_resumed() {
    let mut bench = standing(Scheme::StateFeedback);
    bench.black_box.collect();
    let finger = configuration(Scheme::StateFeedback).fingers[0].clone();
    let gravity = configuration(Scheme::StateFeedback).gravity(FingerNumber::ONE);
    let controlled = Calibration::controlled(&finger, 1000.0);
    bench.black_box.announce_calibration(controlled, gravity, bench.report().controller);
    order_task(&bench, Scheme::StateFeedback, Task::Identify);
    for _ in 0..30 {
        bench.cycles(100);
        bench.black_box.collect();
    }
    assert_eq!(bench.stage(), Stage::Calibrating);
    bench.mailbox.stop();
    bench.faults(FaultKind::FingerStopCall);
    bench.repair();
    bench.opens();
    bench.cycles(100);
    bench.black_box.collect();
    let replayed = bench.black_box.recording().expect("a recording").replay().unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(replayed.different, 0, "{:?}", replayed.first);
}
