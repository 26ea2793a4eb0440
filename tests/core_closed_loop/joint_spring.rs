//! Springs in joint angles and constant joint torques: the finger has the stiffness and the torque that were sent.

use super::rig::{Loop, SCHEMES, poses, quiet, smooth};
use nalgebra::{Matrix3, Vector3};
use sun2xp::control::{Activity, AdmissibleDamping, SetPoint};
use sun2xp::model::configuration::ConfiguredFinger;

fn k_theta() -> Matrix3<f64> {
    Matrix3::new(80.0, 10.0, 0.0, 10.0, 70.0, 15.0, 0.0, 15.0, 50.0)
}

fn spring(joints: Vector3<f64>, k_theta: Matrix3<f64>, torque: Vector3<f64>) -> SetPoint {
    let mut set_point = SetPoint::hard_finger(joints, Matrix3::identity() * 3.0);
    set_point.stiffen_joints(k_theta);
    set_point.torque_joints(torque);
    set_point
}

#[test]
fn a_pushed_finger_has_the_joint_stiffness_that_was_sent() {
    for scheme in SCHEMES {
        let finger = smooth(scheme, [10.0, 30.0, 60.0]);
        let mut servo = Loop::new(&finger, 1000.0);
        let joints = servo.plant.joints();
        let follow = Activity::Follow(spring(joints, k_theta(), Vector3::zeros()));
        let jacobian = finger.links().jacobian(&joints);
        let (mut torques, mut deflections) = (Matrix3::zeros(), Matrix3::zeros());
        for axis in 0..3 {
            let push = Vector3::ith(axis, 0.1);
            let mut at = |force: Vector3<f64>| {
                servo.plant.set_external_force(force);
                servo.run(1.5, &follow);
                servo.mean_joints(0.2, &follow)
            };
            let moved = at(push) - at(-push);
            torques.set_column(axis, &(jacobian.tr_mul(&push) * 2.0));
            deflections.set_column(axis, &moved);
        }
        let measured = torques * deflections.try_inverse().expect("a spring in every direction");
        let off = (measured - k_theta()).amax() / k_theta().amax();
        println!("{scheme:?}: off by {off:.4}, {measured:.2}");
        assert!(servo.report.stiffness_scale == 1.0);
        assert!(off < 0.03, "{scheme:?}: {measured}");
    }
}

#[test]
fn a_held_finger_presses_with_the_torque_that_was_sent() {
    let torque = Vector3::new(3.0, -5.0, 2.0);
    for scheme in SCHEMES {
        let finger = smooth(scheme, [10.0, 30.0, 60.0]);
        let mut servo = Loop::new(&finger, 1000.0);
        let joints = servo.plant.joints();
        servo.plant.hold(joints);
        let still = spring(joints, Matrix3::zeros(), Vector3::zeros());
        assert_eq!(still.joint_spring, None);
        servo.run(1.0, &Activity::Follow(still));
        let before = finger.r() * servo.plant.tensions();
        servo.run(1.5, &Activity::Follow(spring(joints, Matrix3::zeros(), torque)));
        let change = finger.r() * servo.plant.tensions() - before;
        println!("{scheme:?}: {change:.3}");
        assert!(servo.report.torque_scale == 1.0);
        assert!((change - torque).amax() < 0.3, "{scheme:?}: {change}");
    }
}

/// The stiffest springs that a planner can send: for each joint alone, for two joints that are coupled, and for all
/// joints. The finger is pushed and must come to rest. State feedback shakes the joints permanently, with any spring,
/// so the finger may move as much as with the stiffest Kx.
#[test]
fn a_finger_with_a_stiffness_at_the_bound_settles() {
    let shapes = [
        Matrix3::from_diagonal(&Vector3::new(1.0, 0.0, 0.0)),
        Matrix3::from_diagonal(&Vector3::new(0.0, 1.0, 0.0)),
        Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, 1.0)),
        Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.5, -0.5, 0.0, -0.5, 0.5),
        Matrix3::identity(),
    ];
    for rate in [500.0, 1000.0, 2000.0] {
        for scheme in SCHEMES {
            let finger = quiet(scheme);
            let stiffest = finger.stiffness_bound(rate);
            let bound = stiffest * finger.links().0[2].powi(2);
            let (least, most) = AdmissibleDamping::new(&finger, rate).range(stiffest);
            for (pose, damping) in poses().into_iter().zip([1.0, least, most, 1.0]) {
                let damped = |set_point| SetPoint { damping, ..set_point };
                let kx = Matrix3::identity() * stiffest;
                let of_tip = residual_rate(&finger, rate, &damped(SetPoint::hard_finger(pose, kx)));
                for shape in shapes {
                    let set_point = damped(spring(pose, shape * bound, Vector3::zeros()));
                    let of_joints = residual_rate(&finger, rate, &set_point);
                    let case = format!("{scheme:?}, {rate} Hz, {pose:?}, {shape}");
                    println!("{of_joints:.4} of {of_tip:.4} rad/s with Kx");
                    assert!(of_joints < 0.007 + 1.1 * of_tip, "{case}: {of_joints} rad/s, and {of_tip} with Kx");
                }
            }
        }
    }
}

/// Returns the joint rate, rad/s rms over 1 s, that remains 1.5 s after a push. A joint without stiffness does not
/// count. The result is an rms value, because the largest rate in a short time would depend on the phase of the dither.
fn residual_rate(finger: &ConfiguredFinger, rate: f64, set_point: &SetPoint) -> f64 {
    let mut finger = finger.clone();
    finger.simulation.start_degrees = set_point.joints.map(f64::to_degrees).into();
    let mut servo = Loop::new(&finger, rate);
    let follow = Activity::Follow(*set_point);
    servo.run(0.3, &follow);
    servo.plant.set_external_force(Vector3::new(0.3, -0.3, 0.2));
    servo.run(0.05, &follow);
    servo.plant.set_external_force(Vector3::zeros());
    servo.run(1.5, &follow);
    let k_theta = set_point.joint_spring.map_or(Matrix3::identity(), |spring| spring.k_theta);
    let cycles = rate as usize;
    let mut squares = 0.0;
    for _ in 0..cycles {
        servo.cycle(&follow);
        squares += ((k_theta * servo.plant.joint_rates()).amax() / k_theta.amax()).powi(2);
    }
    (squares / cycles as f64).sqrt()
}
