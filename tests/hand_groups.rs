//! Tests of commands to groups of fingers, of waiting for fingers, of their kinematics, and of changes of gravity. The
//! hand has simulated boards that run in real time.

#[allow(dead_code)]
#[path = "common/pauses.rs"]
mod pauses;

use nalgebra::{Matrix3, Vector3};
use std::time::{Duration, Instant};
use sun2xp::finger::Stage;
use sun2xp::groups::{FingerCommand, Until};
use sun2xp::hand::{Hand, HandError, SetPointError};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::motion::{PathPose, Pose};

const LIMIT: Duration = Duration::from_secs(20);

fn open() -> Hand {
    pauses::name_pauses();
    Hand::open(Configuration::default()).unwrap_or_else(|error| panic!("open: {error}"))
}

fn sent(hand: &Hand, commands: &[FingerCommand]) {
    hand.send_group(commands).unwrap_or_else(|error| panic!("{error}"));
}

#[test]
fn a_planner_waits_until_a_group_has_arrived_and_settled() {
    let hand = open();
    let poses = [[0.2, 0.6, 1.1], [-0.2, 0.3, 0.9], [0.1, 0.8, 0.7]];
    for turn in 0..3 {
        let commands = [0, 1, 2].map(|index| FingerCommand::new(index as i32 + 1).joints(poses[(index + turn) % 3]));
        sent(&hand, &commands);
        hand.wait(&[1, 2, 3], Until::Arrived, LIMIT).unwrap_or_else(|error| panic!("{error}"));
        for index in 0..3 {
            let position = Vector3::from(hand.position(index as i32 + 1).expect("a position"));
            let off = (position - Vector3::from(poses[(index + turn) % 3])).amax();
            // The finger may move beyond its set point after it has arrived.
            assert!(off < 0.15, "turn {turn}, finger {}: off by {off} rad", index + 1);
        }
        hand.wait(&[3, 1], Until::Settled, LIMIT).unwrap_or_else(|error| panic!("{error}"));
    }
    // A wait whose condition already holds returns at once, even with a time limit of 0.
    hand.wait(&[1, 2, 3], Until::Settled, LIMIT).unwrap_or_else(|error| panic!("{error}"));
    hand.wait(&[1, 2, 3], Until::Settled, Duration::ZERO).unwrap_or_else(|error| panic!("{error}"));
    hand.wait(&[], Until::Arrived, Duration::ZERO).unwrap_or_else(|error| panic!("{error}"));
    hand.close();
}

#[test]
fn a_wait_ends_with_its_time_limit_or_with_a_fault() {
    let hand = open();
    hand.push_simulated(2, [0.0, 3.0, 0.0]).expect("pushed");
    sent(&hand, &[FingerCommand::new(2).joints([0.2, 0.6, 1.1])]);
    // Because of the push, the finger comes to rest away from its set point.
    hand.wait(&[2], Until::Settled, LIMIT).unwrap_or_else(|error| panic!("{error}"));
    let began = Instant::now();
    let error = hand.wait(&[1, 2, 3], Until::Arrived, Duration::from_millis(300)).expect_err("pushed away");
    assert!(matches!(error, HandError::NotThereInTime(FingerNumber::TWO)), "{error}");
    assert!(error.errno() == libc::ETIMEDOUT && began.elapsed() >= Duration::from_millis(300), "{error}");
    hand.stop(3).expect("a finger");
    let error = hand.wait(&[2, 3], Until::Arrived, LIMIT).expect_err("stopped");
    assert!(error.errno() == libc::EIO && error.to_string().contains("finger 3"), "{error}");
    assert_eq!(hand.wait(&[4], Until::Arrived, LIMIT).expect_err("no finger").errno(), libc::EINVAL);
    hand.close();
}

#[test]
fn a_group_with_a_refused_command_changes_no_finger() {
    let hand = open();
    let before = [1, 2, 3].map(|finger| hand.report(finger).expect("a report").set_point);
    let good = FingerCommand::new(1).joints([0.2, 0.6, 1.1]).stiffness([[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0; 3]]);
    for (bad, word) in [
        (FingerCommand::new(3).joints([9.0, 0.6, 1.1]), "limits"),
        (FingerCommand::new(3).damping(99.0), "damping"),
        (FingerCommand::new(3).tip([f64::NAN, 0.0, 0.0]), "NaN"),
        (FingerCommand::new(1), "two commands"),
        (FingerCommand::new(4), "no finger 4"),
    ] {
        let error = hand.send_group(&[good, bad]).expect_err(word);
        assert!(error.to_string().contains(word), "{error}");
    }
    assert!(matches!(
        hand.send_group(&[good, good]).expect_err("twice"),
        HandError::SetPoint(SetPointError::TwiceInGroup(_))
    ));
    hand.stop(2).expect("a finger");
    while !matches!(hand.report(2).expect("a report").stage, Stage::Faulted(_)) {
        std::thread::yield_now();
    }
    // The error is the fault of finger 2, even if the damping for finger 1 or 2 is out of range.
    let bad = good.damping(99.0);
    for others in [FingerCommand::new(2), FingerCommand::new(2).damping(99.0)] {
        for first in [good, bad] {
            assert_eq!(hand.send_group(&[first, others]).expect_err("faulted").errno(), libc::EIO);
        }
    }
    let cycles = hand.report(1).expect("a report").losses.cycles;
    while hand.report(1).expect("a report").losses.cycles < cycles + 10 {
        std::thread::yield_now();
    }
    for finger in [1, 3] {
        let report = hand.report(finger).expect("a report");
        assert_eq!(report.set_point, before[finger as usize - 1], "finger {finger}");
    }
    sent(&hand, &[good]);
    hand.wait(&[1], Until::Arrived, LIMIT).unwrap_or_else(|error| panic!("{error}"));
    hand.close();
}

fn kx(stiffness: f64) -> [[f64; 3]; 3] {
    (Matrix3::identity() * stiffness).into()
}

/// The manual lists these reasons in the order EINVAL, EDOM, ERANGE. The order of the fingers does not matter.
#[test]
fn a_group_is_refused_for_the_reason_that_its_manual_lists_first() {
    let hand = open();
    let skew = [[1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let far = [9.0, 0.6, 1.1];
    let (one, two) = (FingerCommand::new(1), FingerCommand::new(2));
    for (commands, errno) in [
        (vec![one.stiffness(kx(99.0)), two.stiffness(skew)], libc::EDOM),
        (vec![one.joints(far), two.stiffness(skew)], libc::EDOM),
        (vec![one.joints(far).stiffness(skew), two], libc::EDOM),
        (vec![one.joints(far).stiffness(skew)], libc::EDOM),
        (vec![one.stiffness(skew), two.stiffness(kx(99.0))], libc::EDOM),
        (vec![one.stiffness(skew), two.joints([f64::NAN; 3])], libc::EINVAL),
        (vec![one.stiffness(kx(99.0)), two.joints(far)], libc::ERANGE),
    ] {
        let error = hand.send_group(&commands).expect_err("refused");
        assert_eq!(error.errno(), errno, "{error}");
    }
    hand.close();
}

#[test]
fn a_group_with_paths_is_sent_as_a_whole() {
    let hand = open();
    let set_point = |finger: i32| hand.report(finger).expect("a report").set_point;
    let before = [1, 2, 3].map(set_point);
    let pose = |joints| [PathPose { time: 0.5, pose: Pose::Joints(joints), stiffness: None }];
    let (near, far) = (pose([0.1, 0.5, 1.0]), pose([9.0, 0.5, 1.0]));
    let soft = FingerCommand::new(1).stiffness(kx(1.0));
    // In each case all parts but one are admitted.
    for (commands, paths) in [
        (vec![soft], vec![(2, &near[..]), (3, &far[..])]),
        (vec![soft, FingerCommand::new(3).joints([9.0; 3])], vec![(2, &near[..])]),
        (vec![soft, FingerCommand::new(3).damping(99.0)], vec![(2, &near[..])]),
        (vec![soft], vec![(2, &near[..]), (2, &near[..])]),
    ] {
        hand.send_group_with_paths(&commands, &paths).expect_err("refused");
    }
    hand.stop(3).expect("a finger");
    while !matches!(hand.report(3).expect("a report").stage, Stage::Faulted(_)) {
        std::thread::yield_now();
    }
    let faulted = hand.send_group_with_paths(&[soft], &[(2, &near[..]), (3, &near[..])]).expect_err("faulted");
    assert_eq!(faulted.errno(), libc::EIO, "{faulted}");
    let cycles = hand.report(1).expect("a report").losses.cycles;
    while hand.report(1).expect("a report").losses.cycles < cycles + 10 {
        std::thread::yield_now();
    }
    for finger in [1, 2] {
        assert_eq!(set_point(finger), before[finger as usize - 1], "finger {finger}");
    }
    // The path of finger 2 begins with the damping of its command.
    let damped = FingerCommand::new(2).damping(1.1);
    hand.send_group_with_paths(&[soft, damped], &[(2, &near[..])]).unwrap_or_else(|error| panic!("{error}"));
    hand.wait(&[1, 2], Until::Arrived, LIMIT).unwrap_or_else(|error| panic!("{error}"));
    let (first, second) = (set_point(1), set_point(2));
    assert!((first.stiffness[(0, 0)] - 1.0).abs() < 1e-9 && first.joints == before[0].joints, "{first:?}");
    let off = (second.joints - Vector3::new(0.1, 0.5, 1.0)).amax();
    assert!(off < 1e-9 && second.damping == 1.1 && second.motion.is_none(), "{second:?}");
    hand.close();
}

#[test]
fn kinematics_agree_with_each_other_and_with_the_tip() {
    let hand = open();
    let joints = [0.2, 0.6, 1.1];
    sent(&hand, &[1, 2, 3].map(|finger| FingerCommand::new(finger).joints(joints)));
    hand.wait(&[1, 2, 3], Until::Settled, LIMIT).unwrap_or_else(|error| panic!("{error}"));
    let tip = hand.tip_at(1, joints).expect("a tip");
    let found = hand.joints_at(1, tip).expect("joints");
    assert!((Vector3::from(found) - Vector3::from(joints)).amax() < 1e-9, "{found:?}");
    assert_eq!(hand.joints_at(1, [0.0, 0.0, 99.0]).expect_err("too far").errno(), libc::ERANGE);
    let jacobian = hand.jacobian(1, Some(joints)).expect("a Jacobian");
    for joint in 0..3 {
        let mut moved = joints;
        moved[joint] += 1e-6;
        let to = Vector3::from(hand.tip_at(1, moved).expect("a tip"));
        let slope = (to - Vector3::from(tip)) * 1e6;
        let column = Vector3::from_fn(|row, _| jacobian[row][joint]);
        assert!((slope - column).amax() < 1e-4, "joint {joint}: {slope} {column}");
    }
    for finger in 1..=3 {
        let (pose, now) = (hand.palm_pose(finger).expect("a pose"), hand.fingertip(finger).expect("a tip"));
        let rotation = Matrix3::from_fn(|row, column| pose.rotation[row][column]);
        let tip = Vector3::from(pose.base) + rotation * Vector3::from(now.tip);
        assert!((tip - Vector3::from(pose.tip)).amax() < 0.05, "finger {finger}: {tip}");
        let turned = Matrix3::from_fn(|row, column| pose.tip_rotation[row][column]);
        assert!((turned * turned.transpose() - Matrix3::identity()).amax() < 1e-9);
        let torques = hand.joint_torques(finger).expect("torques");
        let difference = (Vector3::from(torques.measured) - Vector3::from(torques.commanded)).amax();
        assert!(difference < 3.0, "finger {finger} at rest: {torques:?}");
    }
    // Finger 2 has another base than fingers 1 and 3.
    let bases = [1, 2, 3].map(|finger| hand.palm_pose(finger).expect("a pose").base);
    assert!(bases[0] != bases[1] && bases[1] != bases[2]);
    assert_eq!(hand.jacobian(1, Some([f64::NAN, 0.0, 0.0])).expect_err("NaN").errno(), libc::EINVAL);
    hand.close();
}

/// The planner turns the palm a little in every call, as an arm does. The fingers keep their poses, because they
/// compensate the gravity that acts on them. Their recordings can be replayed.
#[test]
fn gravity_turns_while_the_hand_is_open() {
    let hand = open();
    let joints = [0.2, 0.6, 1.1];
    sent(&hand, &[1, 2, 3].map(|finger| FingerCommand::new(finger).joints(joints)));
    hand.wait(&[1, 2, 3], Until::Settled, LIMIT).unwrap_or_else(|error| panic!("{error}"));
    let at = |hand: &Hand, finger| Vector3::from(hand.position(finger).expect("a position"));
    let before = [1, 2, 3].map(|finger| at(&hand, finger));
    for step in 0..250 {
        // Gravity turns once in 500 steps of 2 ms.
        let angle = f64::from(step) * 0.002 * std::f64::consts::TAU;
        hand.set_gravity([9.81 * angle.sin(), 0.0, 9.81 * angle.cos()]).expect("a gravity");
        std::thread::sleep(Duration::from_millis(2));
    }
    // Returns the torques of the fingers, which hold their poses under this gravity.
    let torques = |gravity| {
        hand.set_gravity(gravity).expect("a gravity");
        hand.wait(&[1, 2, 3], Until::Settled, LIMIT).unwrap_or_else(|error| panic!("{error}"));
        std::thread::sleep(Duration::from_millis(300));
        [1, 2, 3].map(|finger| Vector3::from(hand.joint_torques(finger).expect("torques").commanded))
    };
    let (one, other) = (torques([0.0, 9.81, 0.0]), torques([0.0, -9.81, 0.0]));
    for finger in 1..=3 {
        let moved = (at(&hand, finger) - before[finger as usize - 1]).amax();
        assert!(moved < 0.03, "finger {finger} moved by {moved} rad");
        let recording = hand.recording(finger).expect("a recording");
        assert_eq!(recording.origin.controllers.len(), 1, "gravity does not replace controllers");
        let replayed = recording.replay().expect("replayable");
        assert!(replayed.different == 0 && replayed.cycles > 500, "{replayed:?}");
    }
    // Dry friction carries a part of the weight. This part differs between fingers, so the test checks a sum over them.
    let turned: f64 = one.iter().zip(&other).map(|(one, other)| (one - other).amax()).sum();
    assert!(turned > 6.0, "the fingers carry their weight: {one:?} {other:?}");
    for gravity in [[f64::NAN, 0.0, 0.0], [0.0, 0.0, 101.0]] {
        assert_eq!(hand.set_gravity(gravity).expect_err("refused").errno(), libc::EINVAL);
    }
    hand.close();
}
