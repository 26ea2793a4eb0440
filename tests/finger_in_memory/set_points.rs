//! The set point that a finger holds after opening, after a fault and after a calibration: the pose in which it was
//! found, until the planner sends another one.

use crate::motion::{joints, send};
use crate::rig::{Bench, TARGET};
use nalgebra::{Matrix3, Vector3};
use sun2xp::calibration::{Calibration, Task, Verdict};
use sun2xp::control::events::Arrival;
use sun2xp::control::{SetPoint, spatial};
use sun2xp::finger::{Adjustable, CalibrationRun, FaultKind, Order, Recording, Replaced, Stage, Validity};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, ZeroingMethod};
use sun2xp::simulated::{Defect, LineFault};

/// Sends a softer Kx, as SendKx does.
fn soften(bench: &Bench) {
    bench.mailbox.send(|set_point| set_point.stiffness *= 0.5).expect("not faulted");
}

fn stop(bench: &mut Bench) {
    bench.with_finger(|finger| finger.inject(&Defect::EmergencyStop));
    bench.faults(FaultKind::EmergencyStopInput);
    bench.with_finger(|finger| finger.repair());
}

/// Checks that the finger holds these joint angles, with half of its initial stiffness.
fn holds(bench: &mut Bench, joints: Vector3<f64>) {
    bench.cycles(1);
    let held = bench.report().set_point;
    assert_eq!(held.joints, joints, "the finger must hold its target");
    assert!((held.stiffness[(0, 0)] - 1.5).abs() < 1e-12, "{}", held.stiffness);
    bench.cycles(500);
    let moved = (bench.report().cycle.joints - joints).amax();
    assert!(moved < 0.03, "moved by {moved} rad");
}

#[test]
fn a_stiffness_sent_first_after_open_leaves_the_finger_where_it_was_found() {
    let mut bench = Bench::new();
    let found = bench.report().set_point.joints;
    soften(&bench);
    holds(&mut bench, found);
}

#[test]
fn set_points_sent_before_a_fault_are_discarded() {
    let mut bench = Bench::new();
    bench.goes(TARGET);
    let far = TARGET + Vector3::new(0.3, 0.3, 0.3);
    bench.mailbox.send(|set_point| set_point.joints = far).expect("not faulted");
    bench.cycles(20);
    stop(&mut bench);
    bench.repair();
    // A set point that is sent while slack is taken up does not count either.
    bench.mailbox.send(|set_point| set_point.joints = far).expect("not faulted");
    bench.opens();
    let found = bench.report().set_point.joints;
    assert!((found - far).amax() > 0.1, "the finger must be found far from the pose that was sent");
    // This is the first set point that is sent after the recovery.
    soften(&bench);
    holds(&mut bench, found);
}

#[test]
fn of_two_commands_within_a_period_after_recovery_neither_is_overwritten() {
    let mut bench = Bench::new();
    bench.goes(TARGET);
    stop(&mut bench);
    bench.repair();
    bench.opens();
    let near = bench.report().set_point.joints + Vector3::new(0.1, 0.0, 0.0);
    bench.mailbox.send(|set_point| set_point.joints = near).expect("not faulted");
    soften(&bench);
    assert_eq!(bench.mailbox.sent().joints, near);
    bench.cycles(1);
    assert_eq!(bench.report().set_point.joints, near);
}

#[test]
fn orders_in_transit_at_a_fault_are_not_executed_after_recovery() {
    let mut bench = Bench::new();
    bench.goes(TARGET);
    bench.with_finger(|finger| finger.inject(&Defect::EmergencyStop));
    // The servo has not reported the fault yet.
    let configuration = Configuration::default();
    let calibration = Calibration::new(Task::Zero, &configuration.fingers[0], 1000.0).expect("a calibration");
    let adjustable =
        Adjustable { number: 1, ..Adjustable::new(&configuration, FingerNumber::ONE).expect("a controller") };
    let order = bench.mailbox.order(Order::Calibrate(CalibrationRun { calibration, adjustable }));
    assert_eq!(order, Ok(Some(1)));
    bench.faults(FaultKind::EmergencyStopInput);
    bench.with_finger(|finger| finger.repair());
    bench.repair();
    bench.opens();
    bench.cycles(10);
    assert_eq!((bench.stage(), bench.report().orders), (Stage::Running, 1));
    // The next order is accepted.
    assert_eq!(bench.mailbox.order(Order::Restart { limp: true }), Ok(Some(2)));
    bench.cycles(1);
    assert_eq!(bench.stage(), Stage::Limp);
}

#[test]
fn set_points_sent_during_a_calibration_are_discarded() {
    let mut bench = Bench::new();
    bench.goes(TARGET);
    let mut configuration = Configuration::default();
    configuration.fingers[0].zeroing.method = Some(ZeroingMethod::Pose);
    let task = Calibration::new(Task::Zero, &configuration.fingers[0], 1000.0).expect("a calibration");
    configuration.fingers[0] = Calibration::controlled(&configuration.fingers[0], configuration.hand.rate);
    let adjustable =
        Adjustable { number: 1, ..Adjustable::new(&configuration, FingerNumber::ONE).expect("a controller") };
    let order = Order::Calibrate(CalibrationRun { calibration: task, adjustable });
    assert_eq!(bench.mailbox.order(order), Ok(Some(1)));
    bench.cycles(10);
    assert_eq!(bench.stage(), Stage::Calibrating);
    let before = bench.report().set_point;
    bench.mailbox.send(|set_point| set_point.joints = Vector3::new(0.0, 0.0, 0.5)).expect("not faulted");
    bench.until("limp", |bench| {
        assert_eq!(bench.report().set_point, before);
        bench.stage() == Stage::Limp
    });
    assert!(matches!(bench.report().calibration, Some(Verdict::Found(_) | Verdict::Refused(_))));
    assert_eq!(bench.mailbox.order(Order::Restart { limp: false }), Ok(Some(2)));
    bench.cycles(1);
    bench.opens();
    let found = bench.report().set_point.joints;
    soften(&bench);
    holds(&mut bench, found);
}

#[test]
fn a_replay_of_joint_springs_is_exact() {
    let mut bench = Bench::new();
    bench.goes(TARGET);
    let steps: [fn(&mut SetPoint); 4] = [
        |set_point| set_point.stiffen_joints(Matrix3::from_diagonal(&Vector3::new(90.0, 80.0, 50.0))),
        |set_point| set_point.torque_joints(Vector3::new(2.0, -3.0, 1.5)),
        |set_point| set_point.stiffen_tip(spatial(&(Matrix3::identity() * 3.0))),
        |set_point| set_point.torque_joints(Vector3::zeros()),
    ];
    for step in steps {
        bench.mailbox.send(step).expect("not faulted");
        for _ in 0..4 {
            bench.cycles(100);
            bench.black_box.collect();
        }
    }
    assert_eq!(bench.report().set_point.joint_spring, None);
    let recording = bench.black_box.recording().expect("a recording");
    let mut file = Vec::new();
    recording.write(&mut file).expect("written");
    let text = String::from_utf8(file.clone()).expect("text");
    assert!(text.contains("k_theta") && text.lines().any(|line| !line.contains("k_theta")));
    let recording = Recording::read(&file[..], "the file").unwrap_or_else(|error| panic!("{error}"));
    let replayed = recording.replay().unwrap_or_else(|error| panic!("{error}"));
    assert!(replayed.different == 0 && replayed.cycles >= 1200, "{replayed:?}");
}

/// A planner that waits for the arrival reads the number of its set point and the arrival in one report. A report with
/// the number of the new set point must therefore not contain the arrival of the previous motion.
#[test]
fn a_motion_that_begins_without_a_reply_has_not_arrived() {
    for interpolate_ms in [None, Some(100.0)] {
        let mut bench = Bench::with(|is| is.fingers[0].motion.interpolate_ms = interpolate_ms);
        bench.goes(TARGET);
        bench.cycles(500);
        assert!(bench.report().arrival.arrived);
        let far = TARGET + Vector3::new(0.3, 0.3, 0.3);
        match interpolate_ms {
            None => send(&bench, &[joints(1.0, far.into())]),
            Some(_) => bench.mailbox.send(|set_point| set_point.joints = far).expect("not faulted"),
        }
        bench.with_cable(|cable| cable.inject(LineFault::Drop, 1.0, u64::MAX, 1));
        bench.cycles(1);
        let (in_force, report) = bench.mailbox.newest_in_force();
        assert_eq!((in_force, report.arrival), (true, Arrival::default()), "{interpolate_ms:?}");
    }
}

/// A planner may wait for the arrival as soon as a report says that the finger is a spring. This report must therefore
/// contain the arrival already.
#[test]
fn a_finger_that_becomes_a_spring_has_arrived_in_the_same_report() {
    let mut bench = Bench::new();
    let there = (true, Arrival { arrived: true, settled: true });
    let (in_force, report) = bench.mailbox.newest_in_force();
    assert_eq!((in_force, report.arrival), there);
    bench.cycles(1);
    assert_eq!((true, bench.report().arrival), there);
    bench.mailbox.stop();
    bench.faults(FaultKind::FingerStopCall);
    bench.repair();
    bench.opens();
    let (in_force, report) = bench.mailbox.newest_in_force();
    assert_eq!((in_force, report.arrival), there);
}

/// The gate of a hand keeps only the low bits of group numbers. After 2^23 more groups, the gate mistakes the group
/// from before the fault for one that is not posted yet.
#[test]
fn a_group_from_before_a_fault_does_not_hold_later_set_points() {
    let mut bench = Bench::new();
    let change = |set_point: &mut SetPoint| {
        set_point.joints = TARGET;
        Ok::<(), ()>(())
    };
    let grouped = bench.mailbox.prepare((Replaced::Place, Validity::default()), change).expect("not faulted");
    bench.gate.send([Some(grouped.expect("admitted")), None, None]);
    bench.mailbox.stop();
    bench.faults(FaultKind::FingerStopCall);
    // The other fingers go on with their groups.
    for _ in 0..(1 << 23) + 64 {
        bench.gate.send([const { None }; 3]);
    }
    bench.repair();
    bench.opens();
    bench.mailbox.send(|set_point| set_point.joints = TARGET).expect("not faulted");
    bench.cycles(2);
    assert_eq!(bench.report().set_point.joints, TARGET);
}
