//! Calibrations that are refused. Most tests check that the refusal names its cause.

use crate::bench::Bench;
use sun2xp::calibration::{Obstacle, Task};
use sun2xp::model::configuration::Surface;
use sun2xp::model::configuration::{ConfiguredFinger, ZeroingMethod};

fn with_stops() -> ConfiguredFinger {
    let mut finger = ConfiguredFinger::default();
    finger.zeroing.method = Some(ZeroingMethod::Stops);
    finger
}

#[test]
fn a_cut_tendon() {
    for task in [Task::Zero, Task::Identify] {
        let finger = with_stops();
        let mut bench = Bench::new(&finger, &finger, 1000.0);
        // The tendon is so slack that it never becomes taut.
        bench.plant.turn_motor(2, -1e3);
        let refused = bench.calibrate(task);
        assert!(matches!(refused, Err(Obstacle::Slack { tendon: 3, .. })), "{task:?}: {refused:?}");
    }
}

#[test]
fn a_tendon_that_breaks_on_the_way() {
    // The tendon breaks while slack is taken up, or while a stop is searched for.
    for breaks_at in [3.0, 8.0] {
        let finger = with_stops();
        let mut bench = Bench::new(&finger, &finger, 1000.0).open();
        let refused = bench.calibrate_with(Task::Zero, |seconds, plant| {
            if seconds > breaks_at {
                let slack = plant.motor_angles()[1];
                plant.turn_motor(1, -1e3 - slack);
            }
        });
        eprintln!("{breaks_at} s: {refused:?}");
        let expected = match refused {
            Err(Obstacle::Slack { tendon, .. }) => tendon == 2,
            Err(Obstacle::NoStop { .. } | Obstacle::WrongRange { .. } | Obstacle::TimeLimit { .. }) => true,
            _ => false,
        };
        assert!(expected, "{refused:?}");
    }
}

#[test]
fn a_dead_gauge() {
    let finger = ConfiguredFinger::default();
    let mut bench = Bench::new(&finger, &finger, 1000.0).open();
    bench.dead_gauge = Some((3, 220));
    let refused = bench.calibrate(Task::Zero);
    assert!(matches!(refused, Err(Obstacle::DeadGauge { tendon: 4, .. })), "{refused:?}");
    let mut bench = Bench::new(&finger, &finger, 1000.0);
    bench.dead_gauge = Some((1, 0));
    let refused = bench.calibrate(Task::Signs);
    assert_eq!(refused, Err(Obstacle::InconsistentGauge { tendon: 2 }));
}

#[test]
fn a_joint_that_something_blocks() {
    let mut finger = with_stops();
    // An obstacle in the path of joint 0.
    finger.simulation.surface =
        Some(Surface::Wall { point: [3.0, 0.0, 0.0], normal: [-1.0, 0.0, 0.0], stiffness: 300.0 });
    let mut bench = Bench::new(&finger, &finger, 1000.0).open();
    let refused = bench.calibrate(Task::Zero);
    assert!(matches!(refused, Err(Obstacle::WrongRange { joint: 0, .. })), "{refused:?}");
}

/// Identification moves the joints back and forth to measure their friction. The largest torque of this motion does not
/// depend on `zeroing.torque`.
#[test]
fn a_joint_that_is_stuck_while_the_finger_is_identified() {
    let belief = ConfiguredFinger::default();
    let mut finger = belief.clone();
    finger.simulation.joint_coulomb_friction[1] = 0.3;
    let refused = Bench::new(&finger, &belief, 1000.0).open().calibrate(Task::Identify).expect_err("refused");
    assert_eq!(refused, Obstacle::JointBlocked { joint: 1, returning: false });
    assert!(!refused.to_string().contains("zeroing.torque"), "{refused}");
    let returning = Obstacle::JointBlocked { joint: 1, returning: true };
    assert!(returning.to_string().contains("zeroing.torque"), "{returning}");
}

#[test]
fn a_stop_that_is_not_where_it_is_configured() {
    let finger = with_stops();
    let mut belief = finger.clone();
    belief.zeroing.upper_stop_degrees = Some([63.0, 110.0, 123.0]);
    let refused = Bench::new(&finger, &belief, 1000.0).open().calibrate(Task::Zero);
    assert!(matches!(refused, Err(Obstacle::WrongRange { joint: 1, .. })), "{refused:?}");
    let mut truth = finger.clone();
    truth.simulation.stop_margin_degrees = 30.0;
    let refused = Bench::new(&truth, &finger, 1000.0).open().calibrate(Task::Zero);
    assert!(matches!(refused, Err(Obstacle::NoStop { joint: 0, .. })), "{refused:?}");
}

/// The stops of the finger are 2.5 degrees farther out than configured.
#[test]
fn a_range_that_is_larger_than_configured() {
    let finger = with_stops();
    let mut truth = finger.clone();
    truth.simulation.stop_margin_degrees = 5.5;
    let refused = Bench::new(&truth, &finger, 1000.0).open().calibrate(Task::Zero).expect_err("refused");
    let Obstacle::WrongRange { joint: 0, degrees, expected } = refused else { panic!("{refused:?}") };
    assert!((degrees - expected - 5.0).abs() < 2.0, "{refused:?}");
    let text = refused.to_string();
    assert!(text.contains("upper_stop_degrees") && !text.contains("zeroing.torque"), "{text}");
}

#[test]
fn a_board_that_lost_its_counts_keeps_no_zero() {
    let mut finger = ConfiguredFinger::default();
    finger.zeroing.method = Some(ZeroingMethod::Kept);
    let mut bench = Bench::new(&finger, &finger, 1000.0).open();
    bench.zero_valid = false;
    assert_eq!(bench.calibrate(Task::Zero), Err(Obstacle::NotKept));
}

#[test]
fn a_finger_that_is_shaken_while_its_gauges_are_read() {
    let finger = ConfiguredFinger::default();
    let mut bench = Bench::new(&finger, &finger, 1000.0).open();
    let refused = bench.calibrate_with(Task::Zero, |seconds, plant| {
        let push = 3.0 * (seconds * 30.0).sin();
        plant.set_external_force(nalgebra::Vector3::new(push, push, push));
    });
    assert!(refused.is_err(), "{refused:?}");
}

#[test]
fn a_routine_that_takes_too_long() {
    let mut finger = with_stops();
    finger.zeroing.time_limit_s = 2.0;
    let refused = Bench::new(&finger, &finger, 1000.0).open().calibrate(Task::Zero);
    assert_eq!(refused, Err(Obstacle::TimeLimit { seconds: 2.0 }));
    let text = Obstacle::TimeLimit { seconds: 2.0 }.to_string();
    assert!(text.contains("something slows the finger down, or zeroing.time_limit_s is too short"), "{text}");
}

/// Swaps every pair of gauges and every pair of motors, at three rates, with tight and with slack tendons.
#[test]
fn cables_of_two_gauges_or_two_motors_that_are_swapped() {
    let finger = ConfiguredFinger::default();
    for (rate, slack) in [(500.0, 0.0), (500.0, 2.0), (1000.0, 2.0), (2000.0, 0.0)] {
        for (one, other) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            let bench = || {
                let mut bench = Bench::new(&finger, &finger, rate);
                (0..4).for_each(|motor| bench.plant.turn_motor(motor, -slack * (1.0 + 0.3 * motor as f64)));
                bench
            };
            let number = |index: usize| index as u8 + 1;
            let mut gauges = bench();
            gauges.gauge_at.swap(one, other);
            let expected = Obstacle::Swapped { motor: number(one), gauge: number(other) };
            assert_eq!(gauges.calibrate(Task::Signs), Err(expected), "{rate} Hz, {slack}");
            let mut motors = bench();
            motors.motor_at.swap(one, other);
            let expected = Obstacle::SwappedMotor { motor: number(one), encoder: number(other) };
            assert_eq!(motors.calibrate(Task::Signs), Err(expected), "{rate} Hz, {slack}");
        }
    }
}

#[test]
fn a_motor_that_does_not_turn() {
    let mut finger = ConfiguredFinger::default();
    let belief = finger.clone();
    finger.simulation.motor_coulomb_friction[2] = 0.02;
    let refused = Bench::new(&finger, &belief, 1000.0).calibrate(Task::Signs);
    assert_eq!(refused, Err(Obstacle::MotorStuck { motor: 3 }));
}
