//! Tests the measurements of `cargo bench --bench stiffness`: they must reproduce known results, and must detect
//! controllers that are wrong.

#![allow(dead_code, reason = "the bench uses the rest of these files")]

#[path = "../benches/stiffness/cases.rs"]
mod cases;
#[path = "../benches/stiffness/closed_loop.rs"]
mod closed_loop;
#[path = "../benches/stiffness/contact.rs"]
mod contact;
#[path = "../benches/stiffness/fits.rs"]
mod fits;
#[path = "../benches/stiffness/parallel.rs"]
mod parallel;
#[path = "../benches/stiffness/stability.rs"]
mod stability;
#[path = "../benches/stiffness/statics.rs"]
mod statics;

use cases::{Case, Friction};
use closed_loop::{ClosedLoop, Held, Senses};
use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, Vector3};
use stability::Sample;
use sun2xp::control::Controller;
use sun2xp::model::configuration::{ConfiguredFinger, Law, Scheme};

fn case(scheme: Scheme) -> Case {
    Case { scheme, rate: 1000.0, poses: 3, seed: 3, law: Law::Exact, numbers: None }
}

#[test]
fn a_known_spring_shows_its_stiffness_and_its_error() {
    let turn = Rotation3::from_euler_angles(0.3, -0.8, 1.1);
    let kx = turn * Matrix3::from_diagonal(&Vector3::new(1.0, 5.0, 2.0)) * turn.inverse();
    // 8 % too stiff in one principal direction. Errors are scaled by the root of Kx, so rotation and anisotropy must
    // not change the result.
    let soft = turn * Vector3::x();
    let true_stiffness = kx + soft * soft.transpose() * 0.08;
    let deflections = [Vector3::new(0.1, 0.0, 0.02), Vector3::new(0.03, 0.1, 0.0), Vector3::new(0.0, 0.05, 0.1)];
    let forces = deflections.map(|deflection| true_stiffness * deflection);
    assert!((fits::apparent_stiffness(&forces, &deflections) - true_stiffness).amax() < 1e-12);
    assert!((fits::spring_error(&forces, &deflections, &kx) - 0.08).abs() < 1e-12);
    assert!(fits::spring_error(&forces, &deflections, &true_stiffness) < 1e-12);
    // A tip that does not move or has no valid position is no spring.
    assert_eq!(fits::spring_error(&forces, &[Vector3::zeros(); 3], &kx), f64::INFINITY);
    assert_eq!(fits::spring_error(&forces, &[Vector3::repeat(f64::NAN); 3], &kx), f64::INFINITY);
}

#[test]
fn a_line_shows_its_slope_and_a_hysteresis_its_mean() {
    let line: Vec<(f64, f64)> = (0..50).map(|i| (0.1 * f64::from(i), 4.0 - 0.3 * f64::from(i))).collect();
    assert!((fits::slope(&line) + 3.0).abs() < 1e-12);
    // Up with an offset, down with the opposite offset.
    let up = (-20..=20).map(|i| (f64::from(i), 2.0 * f64::from(i) + 5.0));
    let down = (-20..=20).map(|i| (f64::from(i), 2.0 * f64::from(i) - 5.0));
    assert!((fits::slope(&up.chain(down).collect::<Vec<_>>()) - 2.0).abs() < 1e-12);
}

/// Returns `count` observations of x[k+1] = A x[k], where A has these modes. Each value of an observation is a mixture
/// of the components of x.
fn decay(modes: &[(f64, f64)], count: usize) -> Vec<DVector<f64>> {
    let size = 2 * modes.len();
    let mut a = DMatrix::zeros(size, size);
    for (index, &(modulus, angle)) in modes.iter().enumerate() {
        let (sin, cos) = angle.sin_cos();
        let block = nalgebra::Matrix2::new(cos, -sin, sin, cos) * modulus;
        a.view_mut((2 * index, 2 * index), (2, 2)).copy_from(&block);
    }
    let mixture = DMatrix::from_fn(10, size, |row, column| ((3 * row + 7 * column + row * column) as f64).sin());
    let mut state = DVector::from_element(size, 1e-6);
    (0..count)
        .map(|_| {
            let seen = &mixture * &state;
            state = &a * &state;
            seen
        })
        .collect()
}

#[test]
fn a_known_decay_shows_its_slowest_mode() {
    for (modes, slowest) in [
        (&[(0.98, 0.4), (0.7, 1.0), (0.5, 2.0)][..], 0.98),
        // Two close modes and a real one.
        (&[(0.96, 0.2), (0.95, 0.5), (0.3, 0.0)], 0.96),
        // A real mode is the slowest.
        (&[(0.99, 0.0), (0.9, 0.3)], 0.99),
        // A mode grows.
        (&[(1.01, 0.3), (0.99, 0.1)], 1.01),
        // A mode hardly decays.
        (&[(0.9999, 0.05), (0.8, 1.0)], 0.9999),
        // Modes that have decayed long before the end.
        (&[(0.5, 0.3), (0.4, 0.0)], 0.5),
    ] {
        let found = fits::growth(&decay(modes, 300));
        assert!((found - slowest).abs() < 2e-4, "{found} for {slowest}");
    }
    assert!(fits::growth(&[]).is_nan());
    let mut lost = decay(&[(0.9, 0.1)], 100);
    lost[50][3] = f64::NAN;
    assert!(fits::growth(&lost).is_nan());
    assert!(fits::growth(&vec![DVector::zeros(3); 100]).is_nan());
}

/// The difference of two motions follows no linear recurrence if only one of them meets an obstacle. The mean change
/// must then show whether the difference decays or grows.
#[test]
fn a_nonlinear_decay_is_not_taken_for_growth() {
    let mut bent = decay(&[(0.97, 0.2), (0.9, 0.7)], 200);
    for (number, sample) in bent.iter_mut().enumerate() {
        let kinked = 1.0 + 0.3 * f64::from(u8::from(number % 7 < 3));
        *sample *= kinked;
        sample[number % 10] *= 1.5;
    }
    let found = fits::growth(&bent);
    assert!(found > 0.9 && found < 1.0, "{found}");
    // The same motion in reverse, so that it grows.
    bent.reverse();
    assert!(fits::growth(&bent) > 1.0);
}

#[test]
fn not_a_number_counts_as_the_worst() {
    assert_eq!(parallel::worst([1.0, f64::NAN, 2.0]), f64::INFINITY);
    assert_eq!(parallel::least([1.0, f64::NAN, 2.0]), f64::NEG_INFINITY);
    let items: Vec<usize> = (0..100).collect();
    assert_eq!(parallel::each(&items, |number, item| number + item), (0..200).step_by(2).collect::<Vec<_>>());
}

/// Without compensation of the tendon stretch the tip is softer by about a third at 3 N/cm, and by half at 6 N/cm.
#[test]
fn a_controller_that_ignores_tendon_stretch_is_detected() {
    let case = case(Scheme::Figure10);
    for (stiffness, least, most) in [(3.0, 0.1, 0.45), (6.0, 0.2, 0.7)] {
        for pose in case.poses() {
            let kx = Matrix3::identity() * stiffness;
            let finger = case.finger(&pose, Friction::None);
            let mut blind = finger.clone();
            blind.tendon.stiffness = [1e9; 4];
            let error = |belief: &ConfiguredFinger| {
                let held = Held { case: &case, finger: &finger, belief, pose: &pose, kx: &kx, senses: Senses::Exact };
                statics::fidelity(&held).error
            };
            assert!(error(&finger) < 2e-3, "{}", error(&finger));
            assert!((least..most).contains(&error(&blind)), "{}", error(&blind));
        }
    }
}

/// A servo that gives less than the commanded stiffness reports the scale. The difference must not count as a stiffness
/// error.
#[test]
fn a_pose_that_supports_less_stiffness_shows_its_scale_and_no_error() {
    let case = case(Scheme::StateFeedback);
    let pose = Vector3::new(0.02, -0.03, 0.76);
    let finger = case.finger(&pose, Friction::None);
    let kx = Matrix3::identity() * 7.5;
    let held = Held { case: &case, finger: &finger, belief: &finger, pose: &pose, kx: &kx, senses: Senses::Exact };
    let found = statics::fidelity(&held);
    assert!(found.scale < 0.97 && found.error < 0.01, "{} of {}", found.error, found.scale);
}

/// A motor constant that is wrong by 20 % is harmless in the conversion of a tension to a torque. The matrix (RM)^-T
/// converts motor angles to joint angles. Its M consists of motor radii, and must not contain the motor constant. If it
/// does, the measured joint angles are 25 % too large (1 / 0.8), and the tip is displaced.
#[test]
fn a_motor_model_in_the_kinematics_is_detected() {
    let case = case(Scheme::Figure11);
    for pose in case.poses() {
        let kx = Matrix3::identity() * 3.0;
        let finger = case.finger(&pose, Friction::None);
        let mut off = finger.clone();
        off.simulation.motor_constant_ratio = [0.8; 4];
        let mut in_kinematics = off.clone();
        in_kinematics.geometry.motor_radius = finger.geometry.motor_radius.map(|radius| radius / 0.8);
        let displaced = |finger: &ConfiguredFinger, belief: &ConfiguredFinger| {
            let held = Held { case: &case, finger, belief, pose: &pose, kx: &kx, senses: Senses::Exact };
            let mut run = ClosedLoop::new(&held);
            run.run(2.0);
            (run.plant.tip() - run.anchor()).norm()
        };
        let (right, wrong) = (displaced(&off, &finger), displaced(&off, &in_kinematics));
        assert!(right < 0.01 && (wrong.is_nan() || wrong > 0.3), "{right} cm, in the kinematics {wrong} cm");
    }
}

/// The report of 1990 prints R with one wrong sign. With the printed R, the tendons cannot all pull while the joints
/// are at rest.
#[test]
fn the_printed_r_is_refused_by_every_scheme() {
    let case = case(Scheme::StateFeedback);
    let mut printed = case.finger(&Vector3::new(0.0, 0.5, 1.0), Friction::None);
    assert_eq!(printed.geometry.r[1][3], -1.09);
    printed.geometry.r[1][3] = 1.09;
    for scheme in [Scheme::Figure9, Scheme::Figure10, Scheme::Figure11, Scheme::StateFeedback] {
        printed.controller.scheme = Some(scheme);
        let refused = Controller::new(&printed, case.rate).expect_err("tendons that cannot all pull");
        assert_eq!(refused.key, "geometry.r", "{scheme:?}: {}", refused.reason);
    }
}

#[test]
fn a_controller_without_damping_is_detected() {
    let case = case(Scheme::Figure10);
    for pose in case.poses() {
        let sample = Sample { pose, kx: Matrix3::identity() * 3.0, load: Vector3::new(0.05, -0.1, 0.1), wall: None };
        let damped = stability::growth(&case, &case.finger(&pose, Friction::None), &sample);
        assert!(damped.is_some_and(|growth| growth > 0.9 && growth < 1.0), "{damped:?}");
        let mut undamped = case.finger(&pose, Friction::None);
        undamped.controller.motor_damping = Some(0.0);
        undamped.controller.rate_time = Some(0.0);
        let undamped = stability::growth(&case, &undamped, &sample);
        assert!(undamped.is_none_or(|growth| growth > 1.0), "{undamped:?}");
    }
}

/// The eigenvalue must predict how fast a loaded finger comes to rest after a nudge. The test measures this separately,
/// from the motion of the tip over time.
#[test]
fn the_largest_eigenvalue_predicts_how_a_finger_comes_to_rest() {
    let case = case(Scheme::Figure10);
    for pose in case.poses() {
        let kx = Matrix3::identity() * 3.0;
        let finger = case.finger(&pose, Friction::None);
        let load = Vector3::new(0.05, -0.1, 0.1);
        let growth =
            stability::growth(&case, &finger, &Sample { pose, kx, load, wall: None }).expect("a stable finger");
        let belief = &finger;
        let held = Held { case: &case, finger: &finger, belief, pose: &pose, kx: &kx, senses: Senses::Exact };
        let mut run = ClosedLoop::new(&held);
        run.push(load * 1.01);
        run.run(3.0);
        let rest = run.plant.tip();
        // Nudges the finger. After the fast modes have decayed, compares the largest distances in two windows.
        run.plant.turn_motor(0, 1e-2);
        run.run(0.2);
        let mut largest = |seconds| parallel::worst(run.tips(seconds).iter().map(|tip| (tip - rest).norm()));
        let (early, _, late) = (largest(0.25), largest(0.15), largest(0.25));
        let found = (late / early).powf(1.0 / 400.0);
        assert!((found - growth).abs() < 3e-3, "{found} for {growth}");
    }
}
