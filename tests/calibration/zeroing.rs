//! Tests of the zeros of encoders and gauges.

use crate::bench::Bench;
use crate::identifying::identified;
use nalgebra::Vector3;
use sun2xp::calibration::{Findings, Task, Zeros};
use sun2xp::control::{Activity, Law, SetPoint};
use sun2xp::model::configuration::{ConfiguredFinger, ZeroingMethod};

pub fn zeroed(bench: &mut Bench) -> Zeros {
    match bench.calibrate(Task::Zero) {
        Ok(Findings::Zeros(found)) => found,
        other => panic!("{other:?}"),
    }
}

/// A finger whose zeros are far from the zeros with which a controller starts.
fn truth() -> ConfiguredFinger {
    let mut truth = ConfiguredFinger::default();
    truth.encoder.zero = [1200, -800, 40_000, -3];
    truth.gauge.zero = [220.0, 180.0, 205.0, 195.0];
    truth
}

/// Largest difference between a true joint angle and the controller's, rad, after the controller has adopted the
/// findings.
fn joint_error(bench: Bench) -> f64 {
    let bench = bench.adopt();
    (bench.plant.joints() - bench.report.joints).amax()
}

#[test]
fn zeroing_against_the_stops_works_from_any_pose() {
    let truth = truth();
    for (rate, start) in [(500.0, [0.0, 30.0, 60.0]), (1000.0, [40.0, -10.0, 100.0]), (2000.0, [-55.0, 90.0, 20.0])] {
        let mut actual = truth.clone();
        actual.simulation.start_degrees = start;
        let mut belief = ConfiguredFinger::default();
        belief.zeroing.method = Some(ZeroingMethod::Stops);
        belief.gauge.zero = [200.0; 4];
        belief.tendon.stiffness = [270.0; 4];
        let mut bench = Bench::new(&actual, &belief, rate);
        let found = zeroed(&mut bench);
        eprintln!("stops {rate} Hz: {found:?}");
        for motor in 0..4 {
            assert!((found.encoder[motor] - truth.encoder.zero[motor]).abs() <= 8, "{rate} Hz: {found:?}");
            assert!((found.gauge[motor] - truth.gauge.zero[motor]).abs() < 0.5, "{rate} Hz: {found:?}");
        }
        assert!(found.range_error.is_some_and(|range| range.amax() < 0.005), "{found:?}");
        let error = joint_error(bench);
        assert!(error < 1.5e-3, "{rate} Hz: {error}");
    }
}

#[test]
fn zeroing_at_the_configured_pose_works() {
    let truth = truth();
    let mut belief = ConfiguredFinger::default();
    belief.tendon.stiffness = [330.0; 4];
    // The zeros of the gauges are right, as after an earlier zeroing. So the finger keeps its pose, although nothing
    // holds it.
    belief.gauge.zero = truth.gauge.zero;
    let mut bench = Bench::new(&truth, &belief, 1000.0);
    bench.run(1.0, &Activity::TakeUpSlack);
    bench.belief.zeroing.pose_degrees = bench.plant.joints().map(f64::to_degrees).into();
    let found = zeroed(&mut bench);
    eprintln!("pose: {found:?}");
    for motor in 0..4 {
        assert!((found.encoder[motor] - truth.encoder.zero[motor]).abs() <= 3, "{found:?}");
        assert!((found.gauge[motor] - truth.gauge.zero[motor]).abs() < 0.5, "{found:?}");
    }
    let error = joint_error(bench);
    assert!(error < 1e-3, "{error}");
}

#[test]
fn a_board_that_kept_its_counts_keeps_the_zeros_of_encoders_but_not_of_gauges() {
    let truth = truth();
    let mut belief = truth.clone();
    belief.zeroing.method = Some(ZeroingMethod::Kept);
    belief.gauge.zero = truth.gauge.zero.map(|zero| zero + 20.0);
    let mut bench = Bench::new(&truth, &belief, 1000.0);
    let found = zeroed(&mut bench);
    assert_eq!(found.encoder, truth.encoder.zero);
    for tendon in 0..4 {
        assert!((found.gauge[tendon] - truth.gauge.zero[tendon]).abs() < 0.5, "{found:?}");
    }
}

/// The purpose of identification: a finger whose tendons are 10 % stiffer than configured becomes the commanded spring.
#[test]
fn a_calibrated_finger_is_the_commanded_spring() {
    let mut truth = truth();
    truth.simulation.tendon_stiffness = [330.0; 4];
    truth.simulation.joint_coulomb_friction = [0.5e-3; 3];
    let mut belief = ConfiguredFinger::default();
    belief.zeroing.method = Some(ZeroingMethod::Stops);
    belief.gauge.zero = [200.0; 4];
    let mut bench = Bench::new(&truth, &belief, 1000.0);
    zeroed(&mut bench);
    let mut bench = bench.adopt();
    identified(&mut bench);

    // The stiffness before and after the calibration is measured without joint friction, which is a separate effect.
    truth.simulation.joint_coulomb_friction = [0.0; 3];
    let mut uncalibrated = bench.belief.clone();
    uncalibrated.tendon.stiffness = [300.0; 4];
    let (before, after) = (apparent_error(&truth, &uncalibrated), apparent_error(&truth, &bench.belief));
    println!("apparent stiffness error before {before:.4}, after {after:.4}");
    assert!(before > 1.5 * after, "the test must be able to see a wrong stiffness: {before}");
    assert!(after <= 0.01, "{after}");
}

/// Largest relative error of the apparent compliance of the tip, over pushes of 0.9 N along every axis.
fn apparent_error(truth: &ConfiguredFinger, belief: &ConfiguredFinger) -> f64 {
    let mut bench = Bench::new(truth, belief, 1000.0).open();
    let stiffness = nalgebra::Matrix3::identity() * 3.0;
    let hold = Activity::Follow(SetPoint { law: Law::Exact, ..SetPoint::hard_finger(bench.report.joints, stiffness) });
    let settled = |bench: &mut Bench, force: Vector3<f64>| {
        bench.plant.set_external_force(force);
        bench.run(3.0, &hold);
        let mut sum = Vector3::zeros();
        for _ in 0..1000 {
            bench.run(0.001, &hold);
            sum += bench.plant.tip();
        }
        sum / 1000.0
    };
    let mut worst: f64 = 0.0;
    for axis in 0..3 {
        let force = Vector3::ith(axis, 0.9);
        let (there, back) = (settled(&mut bench, force), settled(&mut bench, -force));
        let moved = (there - back) / 2.0;
        worst = worst.max((moved * 3.0 - force).norm() / 0.9);
    }
    worst
}
