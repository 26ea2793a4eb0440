//! Gravity, what a pose can carry, soft joint limits, warm motors: the same for every scheme.

use super::rig::{Loop, finger_with, spring};
use nalgebra::Vector3;
use sun2xp::control::monitors::Symptom;
use sun2xp::model::configuration::Scheme;

const SCHEMES: [Scheme; 3] = [Scheme::Figure9, Scheme::Figure10, Scheme::StateFeedback];

#[test]
fn gravity_does_not_move_the_finger_unless_it_is_left_alone() {
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
fn a_pose_that_cannot_carry_the_stiffness_gets_what_it_can() {
    for scheme in SCHEMES {
        let finger = finger_with(scheme);
        let mut servo = Loop::new(&finger, 1000.0);
        let pose = servo.plant.joints();
        servo.run(0.5, &spring(pose, 3.0));
        assert_eq!(servo.report.stiffness_scale, 1.0);
        // Four times the bound: nobody could send it, and here it must not make the finger swing.
        servo.run(1.0, &spring(pose, 24.0));
        let scale = servo.report.stiffness_scale;
        assert!(scale > 0.2 && scale < 0.8, "{scheme:?}: {scale}");
        let links = finger.links();
        let jacobian = links.jacobian(&servo.report.joints);
        let tendons = finger.tendons().unwrap();
        let locked = tendons.r * tendons.r.transpose() * 300.0;
        let part = locked.try_inverse().unwrap() * jacobian.transpose() * jacobian * 24.0 * scale;
        let largest = part.complex_eigenvalues().iter().map(|value| value.re).fold(0.0, f64::max);
        assert!((largest - 0.95).abs() < 0.01, "{scheme:?}: {largest}");
    }
}

#[test]
fn a_joint_beyond_its_limit_is_pushed_back() {
    for scheme in SCHEMES {
        let finger = finger_with(scheme);
        let mut servo = Loop::new(&finger, 1000.0);
        let (_, high) = finger.joint_limits();
        // A limp finger bent by a force: joint 2 would go to its stop.
        let limp = spring(Vector3::zeros(), 0.0);
        let beyond = |servo: &Loop| servo.plant.joints()[2] - high[2];
        servo.plant.set_external_force(Vector3::new(0.0, 0.0, -0.3));
        servo.run(2.0, &limp);
        let pushed = beyond(&servo);
        println!("{scheme:?}: {:?} degrees", servo.plant.joints().map(f64::to_degrees).as_slice());
        assert!(servo.plant.joint_rates().amax() < 0.1, "{scheme:?} swings at its limit");
        assert!(pushed < 3.0f64.to_radians(), "{scheme:?}: {} rad", pushed);
    }
}

#[test]
fn a_motor_that_is_warm_is_limited_to_what_it_can_give_for_ever() {
    let mut finger = finger_with(Scheme::StateFeedback);
    finger.motor.continuous_torque = [1.0; 4];
    finger.motor.thermal_time = 0.5;
    let mut servo = Loop::new(&finger, 1000.0);
    servo.right_alarms = &[Symptom::OverheatedMotor];
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
    assert!(squares.max() > 0.8, "{:?} N^2 cm^2: blind", squares.as_slice());
}
