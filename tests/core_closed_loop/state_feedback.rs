//! Tests of state feedback: settling, steps, pushes, lost replies, walls, and set points whose Kx does not have full
//! rank. Pushes without dither show that the test of pushes can fail.

use super::rig::{Loop, finger_with, poses_of, spring};
use nalgebra::{Matrix3, Vector3};
use sun2xp::control::{Activity, Law, SetPoint};
use sun2xp::model::configuration::Surface;
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};

/// Differs from every seed that was used to design the controller.
const SEED: u64 = 871;

const RATES: [f64; 3] = [500.0, 1000.0, 2000.0];

fn finger() -> ConfiguredFinger {
    finger_with(Scheme::StateFeedback)
}

fn finger_at(pose: &Vector3<f64>) -> ConfiguredFinger {
    let mut finger = finger();
    finger.simulation.start_degrees = pose.map(f64::to_degrees).into();
    finger
}

/// Returns the activity that makes the tip an isotropic spring at the pose `joints`, with the law [`Law::Exact`].
/// `stiffness` is in N/cm.
fn exact(joints: Vector3<f64>, stiffness: f64) -> Activity {
    let set_point = SetPoint::hard_finger(joints, Matrix3::identity() * stiffness);
    Activity::Follow(SetPoint { law: Law::Exact, ..set_point })
}

/// Returns the joint angles at which the tip is displaced by `way` (cm) from its place at `joints`. Newton's method
/// finds them. Returns `None` if it does not find them, or if they are beyond the joint limits or near the straight
/// finger.
pub fn shifted(finger: &ConfiguredFinger, joints: &Vector3<f64>, way: &Vector3<f64>) -> Option<Vector3<f64>> {
    let (links, (low, high)) = (finger.links(), finger.joint_limits());
    let target = links.tip(joints) + way;
    let mut found = *joints;
    for _ in 0..50 {
        found += links.jacobian(&found).try_inverse()? * (target - links.tip(&found));
    }
    let within = (0..3).all(|joint| (low[joint]..high[joint]).contains(&found[joint]));
    ((links.tip(&found) - target).norm() < 1e-9 && within && found[2] > 0.35).then_some(found)
}

#[test]
fn settles_everywhere() {
    for rate in RATES {
        let (mut worst, mut least) = (0.0f64, f64::INFINITY);
        for pose in poses_of(SEED) {
            let mut servo = Loop::new(&finger(), rate);
            let target = spring(pose, 3.0);
            servo.run(1.5, &target);
            assert!(servo.least_commanded >= 5.0);
            least = least.min(servo.least_true);
            servo.forget();
            for _ in 0..2 {
                let error = (servo.mean_joints(0.25, &target) - pose).amax();
                assert!(error < 0.02, "{rate} Hz: {error} rad from {pose}");
                worst = worst.max(error);
            }
            assert!((servo.report.joints - servo.plant.joints()).amax() < 2e-3);
            assert_eq!(servo.report.torque_scale, 1.0);
            assert!(servo.least_true >= 4.0, "{rate} Hz: a settled tension of {} N", servo.least_true);
        }
        println!("{rate} Hz: within {worst:.4} rad, true tensions from {least:.3} N up");
    }
}

struct Step {
    worst: f64,
    median: f64,
    overshoot: f64,
    least_true: f64,
    least_commanded: f64,
}

/// Steps of 5 mm from every pose in three directions.
fn steps(rate: f64, stiffness: f64, loss: f64, change: impl Fn(&mut ConfiguredFinger)) -> Step {
    let mut times = Vec::new();
    let mut found =
        Step { worst: 0.0, median: 0.0, overshoot: 0.0, least_true: f64::INFINITY, least_commanded: f64::INFINITY };
    for (number, pose) in poses_of(SEED).into_iter().enumerate() {
        for axis in 0..3 {
            let mut finger = finger_at(&pose);
            change(&mut finger);
            let direction = Vector3::ith(axis, if (number + axis) % 2 == 0 { 1.0 } else { -1.0 });
            if shifted(&finger, &pose, &(direction * 0.6)).is_none() {
                continue;
            }
            let Some(goal) = shifted(&finger, &pose, &(direction * 0.5)) else { continue };
            let tip = finger.links().tip(&goal);
            let mut servo = Loop::new(&finger, rate);
            servo.run(0.3, &exact(pose, stiffness));
            servo.lose(loss);
            servo.forget();
            let mut last = 0.0;
            for cycle in 1..=(rate as usize) {
                servo.cycle(&exact(goal, stiffness));
                let error = servo.plant.tip() - tip;
                if error.norm() > 0.025 {
                    last = cycle as f64 / rate;
                }
                found.overshoot = found.overshoot.max(error.dot(&direction) / 0.5);
            }
            times.push(last);
            found.least_true = found.least_true.min(servo.least_true);
            found.least_commanded = found.least_commanded.min(servo.least_commanded);
        }
    }
    assert!(times.len() >= 50, "only {} of 72 steps stay within the joint limits", times.len());
    times.sort_by(f64::total_cmp);
    found.median = times[times.len() / 2];
    found.worst = times[times.len() - 1];
    println!(
        "{rate} Hz, {stiffness} N/cm, loss {loss}: {} steps, worst {:.3} s, median {:.3} s, overshoot {:.1} %, \
         tension {:.2} N",
        times.len(),
        found.worst,
        found.median,
        found.overshoot * 100.0,
        found.least_true
    );
    found
}

#[test]
fn steps_are_short_and_hardly_overshoot() {
    for (rate, stiffness) in [(1000.0, 3.0), (1000.0, 6.0), (2000.0, 3.0), (2000.0, 6.0)] {
        let found = steps(rate, stiffness, 0.0, |_| ());
        assert!(found.worst <= 0.15 && found.overshoot <= 0.1);
        assert!(found.least_commanded >= 5.0 && found.least_true >= 2.5);
    }
    for stiffness in [3.0, 5.0] {
        let found = steps(500.0, stiffness, 0.0, |_| ());
        // In one pose the last part of a step is slow.
        assert!(found.worst <= 0.45 && found.median <= 0.15 && found.overshoot <= 0.1);
        assert!(found.least_commanded >= 5.0 && found.least_true >= 2.5);
    }
}

#[test]
fn lost_replies_do_not_matter() {
    let (whole, lost) = (steps(1000.0, 3.0, 0.0, |_| ()), steps(1000.0, 3.0, 0.05, |_| ()));
    assert!(lost.median <= 1.03 * whole.median && lost.worst <= 0.15 && lost.least_true >= 2.5);
}

#[test]
fn motor_constants_a_fifth_off_do_not_matter() {
    for ratio in [0.8, 1.2] {
        let found = steps(1000.0, 3.0, 0.0, |finger| finger.simulation.motor_constant_ratio = [ratio; 4]);
        assert!(found.worst <= 0.15 && found.least_true >= 2.5);
    }
}

/// Returns the largest relative error of the deflection of a spring of 3 N/cm, over poses and directions. The spring is
/// pushed with the force that deflects an ideal spring by `way` cm.
fn push_error(way: f64, change: impl Fn(&mut ConfiguredFinger)) -> f64 {
    let mut worst = 0.0f64;
    for pose in poses_of(SEED).into_iter().step_by(3) {
        for axis in 0..3 {
            let mut finger = finger_at(&pose);
            change(&mut finger);
            let direction = Vector3::ith(axis, 1.0);
            let target = exact(pose, 3.0);
            let mut servo = Loop::new(&finger, 1000.0);
            servo.run(0.3, &target);
            servo.plant.set_external_force(direction * (3.0 * way));
            servo.run(1.5, &target);
            let mut moved = 0.0;
            for _ in 0..500 {
                servo.cycle(&target);
                moved += (servo.plant.tip() - finger.links().tip(&pose)).dot(&direction) / 500.0;
            }
            worst = worst.max((moved / way - 1.0).abs());
        }
    }
    println!("pushed {way} cm: {:.1} % off", worst * 100.0);
    worst
}

#[test]
fn friction_holds_the_finger_only_without_dither() {
    assert!(push_error(0.2, |_| ()) < 0.05);
    let harsh = |finger: &mut ConfiguredFinger| {
        finger.simulation.joint_coulomb_friction = [2e-3; 3];
        finger.friction.joint_coulomb = [0.2; 3];
    };
    assert!(push_error(0.1, harsh) < 0.5);
    let stuck = push_error(0.1, |finger| {
        harsh(finger);
        (finger.controller.dither, finger.controller.tension_dither) = (Some(0.0), Some(0.0));
    });
    assert!(stuck > 0.5, "{stuck}");
}

#[test]
fn the_spring_begins_where_the_finger_is() {
    for rate in RATES {
        for pose in poses_of(SEED).into_iter().step_by(4) {
            let finger = finger_at(&pose);
            let mut servo = Loop::new(&finger, rate);
            servo.run(0.3, &Activity::TakeUpSlack);
            let target = spring(servo.report.joints, 3.0);
            let mut farthest = 0.0f64;
            for _ in 0..(rate as usize / 2) {
                servo.cycle(&target);
                farthest = farthest.max((servo.plant.joints() - pose).amax());
            }
            assert!(farthest < 0.02, "{rate} Hz: {farthest} rad from {pose}");
        }
    }
}

#[test]
fn after_many_missing_replies_the_command_stays_unchanged() {
    let mut servo = Loop::new(&finger(), 1000.0);
    let target = spring(Vector3::new(0.2, 0.7, 1.2), 3.0);
    servo.run(0.5, &target);
    servo.lose(1.0);
    servo.run(0.03, &target);
    let held = servo.report.motor_torques;
    servo.run(0.05, &target);
    assert_eq!(servo.report.motor_torques, held);
    // The finger continues when replies arrive again.
    servo.lose(0.0);
    servo.run(1.0, &target);
    assert!((servo.plant.joints() - Vector3::new(0.2, 0.7, 1.2)).amax() < 0.01);
}

#[test]
fn a_set_point_whose_kx_has_rank_0_or_1_is_damped() {
    for kx in [Matrix3::zeros(), Matrix3::from_diagonal(&Vector3::new(0.0, 3.0, 0.0))] {
        for law in [Law::Report, Law::Exact] {
            let mut servo = Loop::new(&finger(), 1000.0);
            let target = SetPoint { law, ..SetPoint::hard_finger(servo.plant.joints(), kx) };
            servo.plant.set_external_force(Vector3::new(0.3, 0.3, 0.0));
            servo.run(0.1, &Activity::Follow(target));
            assert!(servo.plant.joint_rates().amax() > 0.1);
            servo.plant.set_external_force(Vector3::zeros());
            servo.run(1.5, &Activity::Follow(target));
            assert!(servo.plant.joint_rates().amax() < 0.1, "{}", servo.plant.joint_rates());
            assert!(servo.plant.tensions().min() > 2.5);
        }
    }
}

#[test]
fn walls_are_stable() {
    for (rate, stiffness) in [(500.0, 3.0), (1000.0, 3.0), (1000.0, 6.0), (2000.0, 3.0)] {
        let (mut worst, mut restless, mut touched) = (0.0f64, Vec::new(), 0);
        for pose in poses_of(SEED) {
            for wall in [30.0, 100.0, 300.0] {
                for axis in 0..3 {
                    let normal = Vector3::ith(axis, 1.0);
                    let mut finger = finger_at(&pose);
                    let at = finger.links().tip(&pose) - normal * 0.05;
                    let surface = Surface::Wall { point: at.into(), normal: normal.into(), stiffness: wall };
                    finger.simulation.surface = Some(surface);
                    let Some(goal) = shifted(&finger, &pose, &(normal * -0.4)) else { continue };
                    let mut servo = Loop::new(&finger, rate);
                    servo.run(0.1, &exact(pose, stiffness));
                    servo.run(1.0, &exact(goal, stiffness));
                    touched += u32::from(servo.plant.contact_force().norm() > 0.1);
                    let tips: Vec<_> = (0..(0.3 * rate) as usize)
                        .map(|_| {
                            servo.cycle(&exact(goal, stiffness));
                            servo.plant.tip()
                        })
                        .collect();
                    let mean = tips.iter().sum::<Vector3<f64>>() / tips.len() as f64;
                    let square = tips.iter().map(|tip| (tip - mean).norm_squared()).sum::<f64>() / tips.len() as f64;
                    worst = worst.max(square.sqrt());
                    if square.sqrt() > 0.005 {
                        restless.push((pose.map(f64::to_degrees), wall, axis, square.sqrt()));
                    }
                }
            }
        }
        println!("{rate} Hz, {stiffness} N/cm: tip moves {worst:.4} cm rms against a wall");
        println!("{restless:.4?}");
        assert!(touched >= 150, "only {touched} of 216 tips press against their walls");
        // 6 N/cm is the default bound of Kx at 1000 Hz, so no margin is left: the tip oscillates a little at some
        // walls, but no oscillation grows. At 500 Hz and 3 N/cm, the tip oscillates at more walls, by about 0.1 mm.
        let (most, few) = match (rate, stiffness) {
            (500.0, _) => (0.015, 10),
            (_, 3.0) => (0.005, 0),
            _ => (0.03, 4),
        };
        assert!(worst < most);
        assert!(restless.len() <= few, "{restless:.4?}");
    }
}
