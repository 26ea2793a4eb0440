//! Paths that a finger refuses, and paths that it makes slower.

use crate::motion::{configuration, joints};
use crate::rig::TARGET;
use nalgebra::Vector3;
use sun2xp::control::Motion;
use sun2xp::finger::Reference;
use sun2xp::hand::{PathError, PathPose, Pose, plan_path};
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::OutOfRange;

#[test]
fn refused_paths_name_the_pose_and_the_remedy() {
    let rest = Reference { joints: TARGET, ..Reference::default() };
    let refused = |poses: &[PathPose]| match plan_path(&configuration(), FingerNumber::ONE, &rest, poses) {
        Ok(_) => panic!("accepted"),
        Err(error) => (error.to_string(), error.errno()),
    };
    let tip = |time: f64, tip: [f64; 3]| PathPose { time, pose: Pose::Tip(tip), stiffness: None };
    let with_kx = |time: f64, kx: [[f64; 3]; 3]| PathPose { stiffness: Some(kx), ..joints(time, [0.3, 0.7, 1.2]) };
    let stiff = with_kx(1.0, [[9.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    let skew = |time: f64| with_kx(time, [[1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    let no_number = with_kx(2.0, [[1.0, 0.0, 0.0], [0.0, f64::NAN, 0.0], [0.0, 0.0, 1.0]]);
    for (poses, words, errno) in [
        (vec![], "0 poses", libc::EINVAL),
        (vec![joints(0.5, [0.2, 0.6, 1.1]); 2], "time of pose 1", libc::EINVAL),
        (vec![joints(0.5, [0.2, 0.6, 1.1]); 2], "0.001 s later than the pose before it (0.5 s)", libc::EINVAL),
        (vec![joints(0.0, [0.2, 0.6, 1.1])], "0.001 s later than the beginning of the path (0 s)", libc::EINVAL),
        (vec![joints(f64::NAN, [0.2, 0.6, 1.1])], "time of pose 0", libc::EINVAL),
        (vec![joints(0.5, [0.2, 0.6, 1.1]), tip(1.0, [0.0, 0.0, 9.0])], "another kind", libc::EINVAL),
        (vec![joints(0.5, [0.2, f64::NAN, 1.1])], "NaN", libc::EINVAL),
        (vec![joints(0.5, [0.2, 2.6, 1.1])], "outside the limits", libc::ERANGE),
        (vec![joints(0.05, [0.3, 0.7, 1.2])], "multiply all times by", libc::ERANGE),
        (vec![joints(0.8, [0.2, 1.74, 1.1]), joints(1.6, [0.2, 1.74, 1.2])], "permitted range", libc::ERANGE),
        (vec![tip(1.0, [0.0, 0.0, 20.0])], "pose 0", libc::ERANGE),
        (vec![stiff], "eigenvalue of Kx", libc::ERANGE),
        // If several poses are wrong, the kinds of the errors decide which error is reported. The order of the poses
        // does not matter.
        (vec![stiff, skew(2.0)], "symmetric", libc::EDOM),
        (vec![stiff, no_number], "NaN", libc::EINVAL),
        (vec![skew(1.0), no_number], "NaN", libc::EINVAL),
    ] {
        let (text, number) = refused(&poses);
        assert!(text.contains(words) && number == errno, "{number}: {text}");
    }
}

#[test]
fn a_path_of_an_earlier_spring_phase_names_the_cause_and_the_remedy() {
    let text = PathError::Moved(FingerNumber::ONE).to_string();
    for words in ["recovered or calibrated", "expired", "inhibition after a reflex", ": send the path again"] {
        assert!(text.contains(words), "{words}: {text}");
    }
}

#[test]
fn a_path_that_is_too_fast_is_made_slower_if_commands_are_clamped() {
    let mut clamping = configuration();
    clamping.hand.out_of_range = OutOfRange::Clamp;
    let rest = Reference { joints: TARGET, ..Reference::default() };
    let poses = [joints(0.05, [0.4, 0.7, 1.2]), joints(0.1, [0.2, 0.6, 1.1])];
    let plan = plan_path(&clamping, FingerNumber::ONE, &rest, &poses).unwrap_or_else(|error| panic!("{error}"));
    let pieces = plan.table().pieces;
    assert!(pieces[1].end() > 0.1);
    for (order, limit) in [(1, 5.0), (2, 100.0), (3, 5000.0)] {
        let most = pieces.iter().map(|piece| piece.bounds(order).1.amax()).fold(0.0, f64::max);
        assert!(most <= limit, "{most} of derivative {order}");
    }
    let again = plan_path(&configuration(), FingerNumber::ONE, &rest, &poses);
    assert!(matches!(again, Err(PathError::TooFast { .. })));
}

/// The sum of the time of a pose and 1 ms is rounded, and may be later than the next pose.
#[test]
fn poses_that_are_a_millisecond_apart_are_accepted() {
    let rest = Reference { joints: TARGET, ..Reference::default() };
    let planned = |apart: f64| {
        let poses: Vec<_> = (1..=128).map(|pose| joints(apart * f64::from(pose), TARGET.into())).collect();
        plan_path(&configuration(), FingerNumber::ONE, &rest, &poses).map(drop)
    };
    assert!(planned(1e-3).is_ok(), "{:?}", planned(1e-3));
    assert!(matches!(planned(0.99e-3), Err(PathError::Time { pose: 0, .. })));
}

/// The text gives the factor with two decimal places. The path is admitted with this factor, and refused with the next
/// smaller one.
#[test]
fn the_factor_of_a_path_that_is_too_fast_is_rounded_up() {
    let rest = Reference { joints: TARGET, ..Reference::default() };
    let planned = |time: f64| plan_path(&configuration(), FingerNumber::ONE, &rest, &[joints(time, [0.7, 0.6, 1.1])]);
    for step in 0..20 {
        let time = 0.05 + 0.005 * f64::from(step);
        let text = planned(time).err().expect("too fast").to_string();
        let remedy = text.split_once("multiply all times by ").unwrap_or_else(|| panic!("{text}")).1;
        let factor: f64 = remedy.split(',').next().and_then(|factor| factor.parse().ok()).expect("a factor");
        assert!(planned(time * factor).is_ok(), "{time} s: {text}");
        assert!(planned(time * (factor - 0.01)).is_err(), "{time} s: {text}");
    }
}

/// A finger that is still settling has small speeds, accelerations and jerks. A single polynomial over 30 s that begins
/// with them would move the joints by many rad.
#[test]
fn a_slow_path_of_a_finger_in_motion_is_accepted() {
    let small = Vector3::new(1.0, -1.0, 0.5);
    for scale in [0.1, 1.0] {
        let motion = Motion {
            rates: small * (0.1 * scale),
            accelerations: small * (3.0 * scale),
            jerk: small * (50.0 * scale),
            ..Motion::default()
        };
        let moving = Reference { joints: TARGET, motion, ..Reference::default() };
        let angles = [0.4, 0.9, 1.2];
        let tip = configuration().fingers[0].links().tip(&angles.into());
        for pose in [Pose::Joints(angles), Pose::Tip(tip.into())] {
            let poses = [PathPose { time: 30.0, pose, stiffness: None }];
            let plan = plan_path(&configuration(), FingerNumber::ONE, &moving, &poses);
            let plan = plan.unwrap_or_else(|error| panic!("{scale}: {error}"));
            let pieces = plan.table().pieces;
            let begin = pieces[0].at(0.0);
            assert!((begin.place - TARGET).amax() < 1e-12 && (begin.rates - motion.rates).amax() < 1e-9);
            // A path that first brakes does not continue the acceleration and the jerk.
            assert!(begin.accelerations.amax() < 1e-9 && begin.jerk.amax() < 1e-6);
            assert!((plan.end() - Vector3::from(angles)).amax() < 1e-3);
            // The finger stays between the first and the last place. Only the braking may carry it a little beyond.
            let [low, high] = [TARGET.inf(&angles.into()), TARGET.sup(&angles.into())];
            for piece in pieces {
                for step in 0..=10 {
                    let place = piece.at(piece.begin + piece.length * f64::from(step) / 10.0).place;
                    let off = (low - place).sup(&(place - high)).max();
                    assert!(off < 0.05, "{scale}: {off} rad");
                }
            }
        }
    }
}
