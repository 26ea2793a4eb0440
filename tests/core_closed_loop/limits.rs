//! Gravity, the stiffness that a pose can carry, soft joint limits and warm motors. Most tests run several schemes.

use super::rig::{Loop, SCHEMES, finger_with, spring};
use nalgebra::{Vector3, Vector4};
use sun2xp::control::monitors::Symptom;
use sun2xp::control::{Activity, Controller, Feedback};
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};

#[test]
fn gravity_moves_the_finger_only_without_compensation() {
    for scheme in SCHEMES {
        let mut finger = finger_with(scheme);
        let sag = |compensated: bool, finger: &mut sun2xp::model::configuration::ConfiguredFinger| {
            finger.controller.gravity_compensation = compensated;
            let mut servo = Loop::in_gravity(finger, finger, &Vector3::new(2.0, 9.0, 3.0), 1000.0);
            let pose = servo.plant.joints();
            let target = spring(pose, 3.0);
            servo.run(1.5, &target);
            (finger.links().tip(&servo.mean_joints(0.3, &target)) - finger.links().tip(&pose)).norm()
        };
        let (with, without) = (sag(true, &mut finger), sag(false, &mut finger));
        assert!(with < 0.03 && without > 0.12, "{scheme:?}: {with} cm with, {without} cm without compensation");
    }
}

#[test]
fn a_pose_that_cannot_carry_the_stiffness_gets_the_part_that_it_can_carry() {
    for scheme in SCHEMES {
        let finger = finger_with(scheme);
        let mut servo = Loop::new(&finger, 1000.0);
        let pose = servo.plant.joints();
        servo.run(0.5, &spring(pose, 3.0));
        assert_eq!(servo.report.stiffness_scale, 1.0);
        // Four times the bound. No planner could send this stiffness, and even so the finger must not swing.
        servo.run(1.0, &spring(pose, 24.0));
        let scale = servo.report.stiffness_scale;
        assert!(scale > 0.2 && scale < 0.8, "{scheme:?}: {scale}");
        let links = finger.links();
        let jacobian = links.jacobian(&servo.report.joints);
        let tendons = finger.tendons().unwrap();
        let locked = tendons.r * tendons.r.transpose() * 300.0;
        let part = locked.try_inverse().unwrap() * jacobian.transpose() * jacobian * 24.0 * scale;
        let largest = part.complex_eigenvalues().iter().map(|value| value.re).fold(0.0, f64::max);
        let share = if scheme == Scheme::Figure11 { 0.7 } else { 0.95 };
        assert!((largest - share).abs() < 0.01, "{scheme:?}: {largest}");
    }
}

#[test]
fn a_joint_beyond_its_limit_is_pushed_back() {
    for scheme in SCHEMES {
        let finger = finger_with(scheme);
        let mut servo = Loop::new(&finger, 1000.0);
        let (_, high) = finger.joint_limits();
        // A force bends a limp finger. Without the soft joint limit, the force would push joint 1 to its stop.
        let limp = spring(Vector3::zeros(), 0.0);
        let beyond = |servo: &Loop| servo.plant.joints()[1] - high[1];
        servo.plant.set_external_force(Vector3::new(0.0, 0.0, -0.3));
        // Figure 11 has no gain on the tension error, so motor friction delays the finger's return.
        let seconds = if scheme == Scheme::Figure11 { 4.0 } else { 2.0 };
        let mut farthest = f64::NEG_INFINITY;
        for _ in 0..(seconds * servo.rate) as usize {
            servo.cycle(&limp);
            farthest = farthest.max(beyond(&servo));
        }
        let pushed = beyond(&servo);
        println!("{scheme:?}: {:?} degrees", servo.plant.joints().map(f64::to_degrees).as_slice());
        assert!(farthest > 0.0, "{scheme:?}: joint 1 stays within its limit, by {} rad", -farthest);
        assert!(servo.plant.joint_rates().amax() < 0.1, "{scheme:?} swings at its limit");
        assert!(pushed < 3.0f64.to_radians(), "{scheme:?}: {} rad", pushed);
    }
}

#[test]
fn a_warm_motor_is_limited_to_its_continuous_torque() {
    let mut finger = finger_with(Scheme::StateFeedback);
    finger.motor.continuous_torque = [1.0; 4];
    finger.motor.thermal_time = 0.5;
    let mut servo = Loop::new(&finger, 1000.0);
    // The finger is sent to 172 degrees, where two tendons are slack. A servo would refuse this pose.
    servo.right_alarms = &[Symptom::OverheatedMotor, Symptom::BrokenTendon];
    let far = spring(Vector3::new(3.0, 0.3, 0.6), 6.0);
    let mut first = 0.0f64;
    for _ in 0..400 {
        servo.cycle(&far);
        first = first.max(servo.report.motor_torques.amax());
    }
    assert!(first > 2.5, "{first} N cm");
    servo.run(3.0, &far);
    let mut squares = nalgebra::Vector4::zeros();
    for _ in 0..1000 {
        servo.cycle(&far);
        squares += servo.report.motor_torques.component_mul(&servo.report.motor_torques) / 1000.0;
    }
    assert!(squares.max() < 1.001, "{:?} N^2 cm^2", squares.as_slice());
    assert!(squares.max() > 0.8, "{:?} N^2 cm^2: the motor is not at its limit", squares.as_slice());
}

/// Motor 1 can pull 21 N continuously, and each of the other motors 53 N. The finger presses against a stop, and the
/// wanted torque needs a larger pull of motor 1 than it can give continuously. Figure 11 is left out: it has no gain on
/// the tension error and does not compensate the friction of the motors.
#[test]
fn a_warm_motor_does_not_change_the_direction_of_the_torque() {
    for scheme in [Scheme::Figure9, Scheme::Figure10, Scheme::StateFeedback] {
        let mut finger = finger_with(scheme);
        finger.motor.continuous_torque[0] = 1.0;
        finger.motor.thermal_time = 0.5;
        finger.controller.set_point_speed = Some(1.0);
        let mut servo = Loop::new(&finger, 1000.0);
        servo.right_alarms = &[Symptom::OverheatedMotor];
        // Bent at all joints, so that the torque has no symmetry that would preserve its direction.
        let beyond = spring(Vector3::new(0.4, 3.5, 1.0), 5.0);
        servo.run(6.0, &beyond);
        let (mut asked, mut true_torque, mut pull) = (Vector3::zeros(), Vector3::zeros(), 0.0);
        for _ in 0..500 {
            servo.cycle(&beyond);
            // The mean, because the dither of the tensions varies the pull.
            pull += servo.report.motor_torques[0] / 0.0475 / 500.0;
            asked += servo.report.joint_torques;
            true_torque += finger.r() * servo.plant.tensions();
        }
        let (turned, scale) = (asked.angle(&true_torque).to_degrees(), servo.report.torque_scale);
        println!("{scheme:?}: turned by {turned:.2} degrees, {scale:.3} of the torque, motor 1 pulls {pull:.1} N");
        assert!(pull > 17.0 && pull < 22.0, "{scheme:?}: {pull} N: not at its limit");
        assert!(scale < 0.9, "{scheme:?}: the reported scale of the torque, {scale}, shows no limit");
        assert!(turned < 1.0, "{scheme:?}: turned by {turned} degrees");
    }
}

const FIGURES: [Scheme; 3] = [Scheme::Figure9, Scheme::Figure10, Scheme::Figure11];

/// A finger whose motors can give 21 N continuously, and become warm after half a second with a larger pull.
fn soon_warm(scheme: Scheme) -> ConfiguredFinger {
    let mut finger = finger_with(scheme);
    finger.motor.continuous_torque = [1.0; 4];
    finger.motor.thermal_time = 0.5;
    finger
}

/// Warm motors pull 21 N for a long time while 55 N are wanted. Then 10 N are wanted. An integral that winds up would
/// keep the motors at their limit. Figure 11 is left out: it has no integral. The gauges of this test are constant, so
/// Figure 11 would learn that the motors are weak.
#[test]
fn a_warm_motor_does_not_wind_up_the_integral() {
    for scheme in [Scheme::Figure9, Scheme::Figure10] {
        for rate in [500.0, 1000.0, 2000.0] {
            let controller = Controller::new(&soon_warm(scheme), rate).unwrap();
            let gauges = |newton: f64| Feedback {
                motor_counts: [0; 4],
                gauge_counts: [(newton * 4095.0 / 100.0).round() as u16; 4],
            };
            let held = gauges(1.0 / 0.0475);
            let mut state = controller.start(&held);
            let mut warm = 0.0;
            for _ in 0..(4.0 * rate) as usize {
                let asked = Activity::Tense(Vector4::repeat(55.0));
                warm = controller.cycle(&mut state, Some(&held), &asked).0.motor_torques[0];
            }
            assert!(warm < 1.2, "{scheme:?} at {rate} Hz: {warm} N cm, not warm");
            let (command, _) = controller.cycle(&mut state, Some(&held), &Activity::Tense(Vector4::repeat(10.0)));
            let pull = command.motor_torques[0] / 0.0475;
            assert!(pull < 15.0, "{scheme:?} at {rate} Hz: {pull} N where 10 N are asked for");
        }
    }
}

/// Presses a finger against a stop with the full strength of its motors, then calls it back. Returns the largest excess
/// of a true tension over the desired one, N. The first 30 ms after the call do not count.
fn excess_after_a_stop(finger: &ConfiguredFinger, rate: f64) -> f64 {
    let mut finger = finger.clone();
    finger.controller.set_point_speed = Some(1e3);
    let mut servo = Loop::new(&finger, rate);
    // The finger hits a stop, where tendons become slack, and stays warm for a long time. A tension above 100 N
    // saturates the simulated gauges, and this loop does not give their full scale to the monitors.
    servo.right_alarms = &[Symptom::OverTension, Symptom::OverheatedMotor, Symptom::BrokenTendon, Symptom::GaugeStuck];
    servo.run(3.0, &spring(Vector3::new(0.0, 3.5, 1.0), 5.0));
    let back = spring(servo.plant.joints() - Vector3::new(0.0, 0.05, 0.0), 5.0);
    servo.run(0.03, &back);
    let mut most: f64 = 0.0;
    for _ in 0..rate as usize {
        servo.cycle(&back);
        most = most.max((servo.plant.tensions() - servo.report.desired_tensions).max());
    }
    most
}

#[test]
fn a_warm_finger_that_leaves_a_stop_overshoots_no_more_than_a_cold_one() {
    for scheme in FIGURES {
        for rate in [500.0, 1000.0, 2000.0] {
            let [warm, cold] =
                [soon_warm(scheme), finger_with(scheme)].map(|finger| excess_after_a_stop(&finger, rate));
            println!("{scheme:?} at {rate} Hz: {warm:.2} N warm, {cold:.2} N cold");
            // The allowance is for noise and friction. An integral that winds up adds 10 N and more.
            assert!(warm < cold + 1.5, "{scheme:?} at {rate} Hz: {warm} N warm, {cold} N cold");
        }
    }
}
