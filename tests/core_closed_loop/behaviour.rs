//! What a finger does: settles, is a spring, takes up slack, lets go.

use super::rig::{Loop, finger_with, poses, spring};
use nalgebra::{Matrix3, Vector3, Vector4};
use sun2xp::control::monitors::Symptom;
use sun2xp::control::{Activity, SetPoint};
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};

/// Settled: so near to the target, rad.
const SETTLED: f64 = 0.02;

fn settles_everywhere(scheme: Scheme, rate: f64) {
    let finger = finger_with(scheme);
    let mut worst: f64 = 0.0;
    let mut least: f64 = f64::INFINITY;
    for pose in poses() {
        let mut servo = Loop::new(&finger, rate);
        let target = spring(pose, 3.0);
        servo.run(2.5, &target);
        assert!(servo.least_commanded >= 5.0, "a commanded tension of {} N", servo.least_commanded);
        servo.forget();
        for _ in 0..2 {
            let error = (servo.mean_joints(0.25, &target) - pose).amax();
            assert!(error < SETTLED, "{scheme:?} at {rate} Hz is {error} rad from {pose}");
            worst = worst.max(error);
        }
        assert!(servo.plant.joint_rates().amax() < 0.1, "{scheme:?} at {rate} Hz does not rest at {pose}");
        // The controller knows where the finger is, tendon stretch and all.
        assert!((servo.report.joints - servo.plant.joints()).amax() < 1e-3);
        assert_eq!(servo.report.torque_scale, 1.0);
        least = least.min(servo.least_true);
    }
    println!("{scheme:?} at {rate} Hz: within {worst:.4} rad, true tensions from {least:.3} N up");
    assert!(least >= 4.8, "{scheme:?} at {rate} Hz: a settled tension of {least} N");
}

#[test]
fn figure_9_settles_at_500_hz() {
    settles_everywhere(Scheme::Figure9, 500.0);
}

#[test]
fn figure_9_settles_at_1000_hz() {
    settles_everywhere(Scheme::Figure9, 1000.0);
}

#[test]
fn figure_9_settles_at_2000_hz() {
    settles_everywhere(Scheme::Figure9, 2000.0);
}

#[test]
fn figure_10_settles_at_500_hz() {
    settles_everywhere(Scheme::Figure10, 500.0);
}

#[test]
fn figure_10_settles_at_1000_hz() {
    settles_everywhere(Scheme::Figure10, 1000.0);
}

#[test]
fn figure_10_settles_at_2000_hz() {
    settles_everywhere(Scheme::Figure10, 2000.0);
}

#[test]
fn figure_11_settles_at_500_hz() {
    settles_everywhere(Scheme::Figure11, 500.0);
}

#[test]
fn figure_11_settles_at_1000_hz() {
    settles_everywhere(Scheme::Figure11, 1000.0);
}

#[test]
fn figure_11_settles_at_2000_hz() {
    settles_everywhere(Scheme::Figure11, 2000.0);
}

/// Deflection under 0.3 N, tip, over what the spring of 3 N/cm should give: 1 is a perfect spring.
fn deflection_ratio(finger: &ConfiguredFinger, belief: &ConfiguredFinger) -> f64 {
    let mut servo = Loop::with_belief(finger, belief, 1000.0);
    if belief != finger {
        servo.right_alarms = &[Symptom::GaugeDisagrees];
    }
    let pose = servo.plant.joints();
    let target = spring(pose, 3.0);
    let at = |force: f64, servo: &mut Loop| {
        servo.plant.set_external_force(Vector3::new(0.0, force, 0.0));
        servo.run(1.5, &target);
        let joints = servo.mean_joints(0.2, &target);
        finger.links().tip(&joints).y
    };
    let (down, up) = (at(-0.3, &mut servo), at(0.3, &mut servo));

    (up - down) / 0.2
}

#[test]
fn tip_is_the_commanded_spring_and_is_not_without_stretch_compensation() {
    let mut finger = finger_with(Scheme::Figure10);
    finger.simulation.joint_coulomb_friction = [0.0; 3];
    let ratio = deflection_ratio(&finger, &finger);
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
    // A controller that takes the tendons for rigid feels a finger softer than it should be.
    let mut rigid = finger.clone();
    rigid.tendon.stiffness = [1e9; 4];
    let ratio = deflection_ratio(&finger, &rigid);
    assert!(ratio > 1.05, "{ratio}");
}

#[test]
fn without_damping_the_finger_does_not_rest() {
    for scheme in [Scheme::Figure9, Scheme::Figure10] {
        let mut finger = finger_with(scheme);
        finger.controller.motor_damping = Some(0.0);
        finger.controller.rate_time = Some(0.0);
        let mut servo = Loop::new(&finger, 1000.0);
        // It swings so that tendons are slack and overloaded in turn.
        servo.right_alarms = &[
            Symptom::BrokenTendon,
            Symptom::SlackTendon,
            Symptom::GaugeStuck,
            Symptom::OverTension,
            Symptom::EncoderJump,
        ];
        let target = spring(servo.plant.joints() + Vector3::new(0.1, 0.1, 0.1), 3.0);
        servo.run(2.0, &target);
        let mut fastest: f64 = 0.0;
        for _ in 0..500 {
            servo.cycle(&target);
            fastest = fastest.max(servo.plant.joint_rates().amax());
        }
        assert!(fastest > 1.0, "{scheme:?}: {fastest} rad/s; the tests above do not show that damping is needed");
    }
}

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
            // From there the finger is a spring where it is, and goes where it is sent.
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
fn lost_replies_do_no_harm() {
    let finger = ConfiguredFinger::default();
    for pose in poses().into_iter().take(8) {
        let mut servo = Loop::new(&finger, 1000.0);
        servo.lose(0.05);
        let target = spring(pose, 3.0);
        servo.run(2.5, &target);
        servo.forget();
        assert!((servo.mean_joints(0.3, &target) - pose).amax() < SETTLED);
        assert!(servo.least_true >= 4.8, "{}", servo.least_true);
    }
}

#[test]
fn a_lost_reply_repeats_the_command_but_lets_a_release_go_on() {
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
    // State feedback feels the rate of tensions, so the noise of the gauges too.
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
        // At the switch itself state feedback must not do more than at rest; after it, in motion, it may.
        let switched = servo.largest_jump;
        servo.run(seconds, &activity);
        let largest = if scheme == Scheme::StateFeedback { switched } else { servo.largest_jump };
        // From one cycle to the next: noise and flickering encoders amount to a few N in each.
        assert!(largest < jump, "{scheme:?}, {activity:?}: {largest} N");
    }
    assert_eq!(servo.report.motor_torques, Vector4::zeros());
}

#[test]
fn release_is_a_straight_ramp_from_what_was_pulled() {
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
    // Pushed against its stops by a stiff spring far away: more than 60 N would be needed.
    let mut finger = ConfiguredFinger::default();
    finger.simulation.joint_coulomb_friction = [0.0; 3];
    let mut servo = Loop::new(&finger, 1000.0);
    let far = Activity::Follow(SetPoint::hard_finger(Vector3::new(3.0, 0.3, 0.6), Matrix3::identity() * 6.0));
    servo.run(3.0, &far);
    assert!(servo.report.torque_scale < 1.0, "{}", servo.report.torque_scale);
    assert!(servo.report.desired_tensions.max() <= 60.0 + 1e-9);
    assert!((servo.plant.tensions() - servo.report.desired_tensions).amax() < 0.5);
    let torque = finger.tendons().unwrap().r * servo.plant.tensions();
    let turned = torque.angle(&servo.report.joint_torques).to_degrees();
    assert!(turned < 1.0, "turned by {turned} degrees");
}

#[test]
fn signs_and_zeros_of_motors_and_encoders_are_undone() {
    let mut finger = ConfiguredFinger::default();
    finger.motor.sign = [1, -1, -1, 1];
    finger.encoder.sign = [-1, -1, 1, 1];
    finger.encoder.zero = [12_345, -700, i32::MAX, 3];
    finger.gauge.zero = [10.0, 0.0, 20.5, 3.0];
    let mut servo = Loop::new(&finger, 1000.0);
    let pose = Vector3::new(-0.2, 0.8, 1.1);
    servo.run(2.5, &spring(pose, 3.0));
    assert!((servo.mean_joints(0.2, &spring(pose, 3.0)) - pose).amax() < SETTLED);
    assert!(servo.report.motor_torques[1] < 0.0 && servo.report.motor_torques[0] > 0.0);
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
