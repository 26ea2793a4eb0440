//! Behaviour other than settling: taking up slack, letting go, and observing limits.

use super::rig::{Loop, SETTLED, finger_with, spring};
use nalgebra::{Matrix3, Vector3, Vector4};
use sun2xp::control::{Activity, SetPoint};
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};

#[test]
fn slack_is_taken_up() {
    for (scheme, rate) in [
        (Scheme::Figure9, 500.0),
        (Scheme::Figure10, 1000.0),
        (Scheme::Figure10, 2000.0),
        (Scheme::Figure11, 500.0),
        (Scheme::Figure11, 1000.0),
        (Scheme::Figure11, 2000.0),
        (Scheme::StateFeedback, 500.0),
        (Scheme::StateFeedback, 1000.0),
        (Scheme::StateFeedback, 2000.0),
    ] {
        for unwound in [[3.0; 4], [6.0, 1.0, 4.0, 2.0], [0.0, 0.0, 5.0, 0.0], [0.0; 4]] {
            let finger = finger_with(scheme);
            let mut servo = Loop::new(&finger, rate);
            for (motor, angle) in unwound.into_iter().enumerate() {
                servo.plant.turn_motor(motor, -angle);
            }
            let mut servo = servo.restart();
            let mut cycles = 0;
            while !servo.report.under_tension {
                servo.cycle(&Activity::TakeUpSlack);
                cycles += 1;
                assert!(
                    f64::from(cycles) < 3.0 * rate,
                    "{scheme:?} at {rate} Hz, {unwound:?}: {}",
                    servo.report.tensions
                );
                assert!(servo.plant.tensions().max() < 40.0);
            }
            assert!(servo.report.desired_tensions.min() >= 5.0);
            assert!(servo.plant.tensions().min() >= 4.0);
            // From then on the finger is a spring at its pose, and follows set points.
            let pose = Vector3::new(0.1, 0.6, 1.0);
            servo.run(2.0, &spring(servo.report.joints, 3.0));
            servo.run(2.5, &spring(pose, 3.0));
            assert!((servo.mean_joints(0.2, &spring(pose, 3.0)) - pose).amax() < SETTLED);
        }
    }
}

#[test]
fn a_slack_finger_is_not_under_tension() {
    let mut servo = Loop::new(&ConfiguredFinger::default(), 1000.0);
    servo.plant.turn_motor(2, -3.0);
    let mut servo = servo.restart();
    servo.run(0.001, &Activity::TakeUpSlack);
    assert!(!servo.report.under_tension);
}

#[test]
fn a_lost_reply_repeats_the_command_but_does_not_stop_a_release() {
    let mut servo = Loop::new(&finger_with(Scheme::Figure10), 1000.0);
    let target = spring(Vector3::new(0.2, 0.7, 1.2), 3.0);
    servo.run(0.1, &target);
    let before = servo.report;
    servo.lose(1.0);
    servo.run(0.02, &target);
    assert_eq!(servo.report, before);
    servo.run(0.2, &Activity::Release { ramp: 0.1 });
    assert_eq!(servo.report.motor_torques, Vector4::zeros());
}

#[test]
fn changing_activity_is_bumpless() {
    // State feedback uses the rate of the tensions, so it amplifies the noise of the gauges.
    for (scheme, jump) in [(Scheme::Figure9, 6.0), (Scheme::Figure10, 6.0), (Scheme::StateFeedback, 70.0)] {
        is_bumpless(scheme, jump);
    }
}

fn is_bumpless(scheme: Scheme, jump: f64) {
    let finger = finger_with(scheme);
    let mut servo = Loop::new(&finger, 1000.0);
    let target = spring(Vector3::new(0.2, 0.7, 1.2), 3.0);
    let here = spring(servo.plant.joints(), 3.0);
    let sequence: [(Activity, f64); 7] = [
        (here, 0.3),
        (target, 1.5),
        (Activity::TakeUpSlack, 0.5),
        (target, 1.0),
        (Activity::Release { ramp: 0.2 }, 0.1),
        (target, 1.0),
        (Activity::Release { ramp: 0.2 }, 0.3),
    ];
    for (activity, seconds) in sequence {
        servo.forget();
        servo.cycle(&activity);
        // With state feedback, only the jump at the switch itself is checked: it must not exceed the jumps at rest.
        // Jumps in the motion that follows may be larger.
        let switched = servo.largest_jump;
        servo.run(seconds, &activity);
        let largest = if scheme == Scheme::StateFeedback { switched } else { servo.largest_jump };
        // Noise and flickering encoders change each command by a few N from one cycle to the next.
        assert!(largest < jump, "{scheme:?}, {activity:?}: {largest} N");
    }
    assert_eq!(servo.report.motor_torques, Vector4::zeros());
}

#[test]
fn release_is_a_straight_ramp_from_the_last_pull() {
    let mut servo = Loop::new(&ConfiguredFinger::default(), 1000.0);
    servo.run(0.5, &spring(servo.plant.joints(), 3.0));
    let from = servo.report.motor_torques;
    for cycle in 1..=120 {
        servo.cycle(&Activity::Release { ramp: 0.1 });
        let left = (1.0 - f64::from(cycle) * 0.01).max(0.0);
        assert!((servo.report.motor_torques - from * left).amax() < 1e-9 * from.amax());
    }
    servo.cycle(&Activity::Release { ramp: 0.1 });
    assert_eq!(servo.report.motor_torques, Vector4::zeros());
    let mut at_once = Loop::new(&ConfiguredFinger::default(), 1000.0);
    at_once.cycle(&Activity::Release { ramp: 0.0 });
    assert_eq!(at_once.report.motor_torques, Vector4::zeros());
}

#[test]
fn over_limit_torque_keeps_its_direction() {
    // A stiff spring with a distant set point presses the finger against its stops. The torque of the spring would need
    // tensions above 60 N.
    let mut finger = ConfiguredFinger::default();
    finger.simulation.joint_coulomb_friction = [0.0; 3];
    let mut servo = Loop::new(&finger, 1000.0);
    let far = Activity::Follow(SetPoint::hard_finger(Vector3::new(3.0, 0.3, 0.6), Matrix3::identity() * 6.0));
    servo.run(3.0, &far);
    assert!(servo.report.torque_scale < 1.0, "{}", servo.report.torque_scale);
    assert!(servo.report.desired_tensions.max() <= 60.0 + 1e-9);
    // The means over eleven periods of the dither, which the tensions follow with a lag.
    let (mut tensions, mut desired, mut torques) = (Vector4::zeros(), Vector4::zeros(), Vector3::zeros());
    for _ in 0..250 {
        servo.run(1e-3, &far);
        tensions += servo.plant.tensions() / 250.0;
        desired += servo.report.desired_tensions / 250.0;
        torques += servo.report.joint_torques / 250.0;
    }
    assert!((tensions - desired).amax() < 0.5, "{}", tensions - desired);
    let torque = finger.tendons().unwrap().r * tensions;
    let turned = torque.angle(&torques).to_degrees();
    assert!(turned < 1.0, "turned by {turned} degrees");
}

#[test]
fn without_stiffness_the_finger_is_limp_but_damped() {
    let mut servo = Loop::new(&ConfiguredFinger::default(), 1000.0);
    let limp = spring(Vector3::zeros(), 0.0);
    servo.plant.set_external_force(Vector3::new(0.0, 0.3, 0.0));
    servo.run(0.1, &limp);
    assert!(servo.plant.joint_rates().amax() > 0.1, "{}", servo.plant.joint_rates());
    servo.plant.set_external_force(Vector3::zeros());
    servo.run(1.0, &limp);
    assert!(servo.plant.joint_rates().amax() < 0.05, "{}", servo.plant.joint_rates());
    assert!(servo.plant.tensions().min() > 4.0);
}
