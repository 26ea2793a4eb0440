//! Tests the inverse kinematics against the forward kinematics: over the workspace, at its borders and outside.

use nalgebra::Vector3;
use proptest::prelude::*;
use std::f64::consts::PI;
use sun2xp::model::Links;
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::model::{InverseKinematics, OutOfReach};

const LINKS: Links = Links([3.556, 5.080, 4.000]);

fn unlimited() -> InverseKinematics {
    InverseKinematics::new(LINKS, (Vector3::repeat(-PI), Vector3::repeat(PI)))
}

fn configured() -> InverseKinematics {
    InverseKinematics::new(LINKS, ConfiguredFinger::default().joint_limits())
}

/// Joint angles within the limits of the default finger. The two elbow solutions for a tip position differ in the sign
/// of joint 2. The limits exclude every solution with a negative angle of joint 2, and some solutions with a positive
/// angle.
fn admissible() -> impl Strategy<Value = Vector3<f64>> {
    let degrees = (-60.0..60.0f64, -30.0..100.0f64, 5.0..120.0f64);
    degrees.prop_map(|(a, b, c)| Vector3::new(a, b, c).map(f64::to_radians))
}

fn anywhere() -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-3.1..3.1f64).prop_map(Vector3::from)
}

proptest! {
    #[test]
    fn round_trip_over_the_workspace(theta in admissible()) {
        let found = configured().joints(&LINKS.tip(&theta), &theta).expect("within limits");
        prop_assert!((found - theta).amax() < 1e-9, "{found} {theta}");
    }

    /// Every pose is among the solutions of its tip position, whatever its elbow and the direction of joint 0. The
    /// solutions contain both elbows, and each solution has its tip at the target.
    #[test]
    fn every_pose_is_among_the_solutions(theta in anywhere()) {
        prop_assume!(LINKS.reach(&theta).abs() > 1e-3 && theta[2].sin().abs() > 1e-3);
        let tip = LINKS.tip(&theta);
        let solutions = unlimited().solutions(&tip, 0.0).expect("it is a tip");
        for joints in solutions.iter().flatten() {
            prop_assert!((LINKS.tip(joints) - tip).amax() < 1e-9, "{joints}");
        }
        let nearest = unlimited().joints(&tip, &theta).expect("it is a tip");
        prop_assert!((nearest - theta).amax() < 1e-9, "{nearest} {theta}");
        let elbows = solutions.iter().flatten().map(|joints| joints[2] > 0.0).collect::<Vec<_>>();
        prop_assert!(elbows.contains(&true) && elbows.contains(&false));
    }

    /// Of several solutions the nearest is chosen.
    #[test]
    fn no_solution_is_nearer(theta in anywhere(), present in anywhere()) {
        let tip = LINKS.tip(&theta);
        let chosen = unlimited().joints(&tip, &present).expect("it is a tip");
        for joints in unlimited().solutions(&tip, present[0]).expect("it is a tip").iter().flatten() {
            prop_assert!((joints - present).amax() >= (chosen - present).amax());
        }
    }

    /// The result is either a solution within the limits or a refusal with correct numbers.
    #[test]
    fn any_point_is_reached_or_refused_with_the_numbers(tip in prop::array::uniform3(-16.0..16.0f64)) {
        let tip = Vector3::from(tip);
        let (low, high) = ConfiguredFinger::default().joint_limits();
        let distance = |reach: f64| (reach - 3.556).hypot(tip.y);
        let across = tip.x.hypot(tip.z);
        match configured().joints(&tip, &Vector3::new(0.0, 0.5, 1.0)) {
            Ok(joints) => {
                prop_assert!((LINKS.tip(&joints) - tip).amax() < 2e-4);
                prop_assert!((0..3).all(|joint| joints[joint] >= low[joint] && joints[joint] <= high[joint]));
            }
            Err(OutOfReach::TooFar { distance: reported, reach }) => {
                prop_assert_eq!((reported, reach), (distance(across), 9.08));
                prop_assert!(reported > reach && distance(-across) > reach);
            }
            Err(OutOfReach::TooNear { distance: reported, least }) => {
                prop_assert_eq!(reported, distance(across));
                prop_assert!((least - 1.08).abs() < 1e-12 && reported < least);
            }
            Err(OutOfReach::BeyondLimits { joint, value, low: lowest, high: highest }) => {
                prop_assert!(value < low[joint] || value > high[joint]);
                prop_assert_eq!((lowest, highest), (low[joint], high[joint]));
            }
        }
    }
}

#[test]
fn borders_of_the_workspace_belong_to_it() {
    // In the outstretched and in the folded pose, the two elbow solutions coincide.
    for (theta, tolerance) in [(Vector3::new(0.3, 0.4, 0.0), 1e-7), (Vector3::new(0.3, 0.4, PI), 1e-7)] {
        let tip = LINKS.tip(&theta);
        let found = unlimited().joints(&tip, &theta).expect("on the border");
        assert!((LINKS.tip(&found) - tip).amax() < tolerance, "{found}");
    }
    // Each corner of the joint limits is found again, although its tip position is rounded to float.
    let (low, high) = ConfiguredFinger::default().joint_limits();
    for corner in 0..8 {
        let theta = Vector3::from_fn(|joint, _| if corner >> joint & 1 == 0 { low[joint] } else { high[joint] });
        let tip = LINKS.tip(&theta).map(|value| f64::from(value as f32));
        let found = configured().joints(&tip, &theta).expect("on the limits");
        assert!((found - theta).amax() < 2e-5, "{found} {theta}");
        assert!(found == found.sup(&low).inf(&high));
    }
}

#[test]
fn a_tip_on_the_axis_of_joint_0_leaves_joint_0_where_it_is() {
    let theta = Vector3::new(0.4, 1.6, 2.2);
    let tip = Vector3::new(0.0, -4.0, 0.0);
    let found = unlimited().joints(&tip, &theta).expect("within reach");
    assert_eq!(found[0], 0.4);
    assert!((LINKS.tip(&found) - tip).amax() < 1e-12);
}

#[test]
fn refusals_name_cause_and_numbers() {
    let refusal = |tip: Vector3<f64>| configured().joints(&tip, &Vector3::zeros()).unwrap_err().to_string();
    assert!(refusal(Vector3::new(0.0, 0.0, 14.0)).contains("10.444 cm"), "too far");
    // The target is 0.5 cm beyond the axis of joint 1. The folded finger brings its tip no closer to this axis than
    // 1.08 cm.
    let near = refusal(Vector3::new(0.0, 0.0, 4.056));
    assert!(near.contains("0.500 cm") && near.contains("1.080 cm"), "{near}");
    let behind = refusal(Vector3::new(9.0, -2.0, -6.0));
    assert!(behind.contains("joint 0") && behind.contains("1.0472"), "{behind}");
}
