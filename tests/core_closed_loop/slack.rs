//! Slack is taken up without moving the finger away.

use crate::rig::{Loop, SCHEMES, finger_with, poses};
use nalgebra::{Matrix3, Vector4};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use sun2xp::control::{Activity, SetPoint};
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};

/// How far the joints have moved, rad, when the finger holds its pose after slack was taken up, and how long it took to
/// take up slack, s.
fn drift(finger: &ConfiguredFinger, slack: &Vector4<f64>, rate: f64, take_up: &Activity) -> (f64, f64) {
    let mut servo =
        Loop::with_belief(finger, &ConfiguredFinger { simulation: Default::default(), ..finger.clone() }, rate);
    for motor in 0..4 {
        servo.plant.turn_motor(motor, -slack[motor] / finger.geometry.motor_radius[motor]);
    }
    let mut servo = servo.restart();
    let start = servo.plant.joints();
    let (mut tight, mut cycles) = (0.0, 0.0);
    while tight < 0.02 * rate {
        servo.cycle(take_up);
        tight = if servo.report.under_tension { tight + 1.0 } else { 0.0 };
        cycles += 1.0;
        assert!(cycles < 5.0 * rate, "not under tension: {}", servo.plant.tensions());
    }
    let hold = SetPoint::hard_finger(servo.report.joints, Matrix3::identity() * 3.0);
    servo.run(0.3, &Activity::Follow(hold));
    ((servo.plant.joints() - start).amax(), cycles / rate)
}

/// Largest slack, cm; ratio of each true motor constant to the nominal one; joint friction, N m.
const CASES: [(f64, [f64; 4], f64); 6] = [
    (0.05, [1.0; 4], 0.5e-3),
    (0.15, [1.0; 4], 0.5e-3),
    (0.5, [1.0; 4], 0.5e-3),
    (0.15, [1.2, 0.8, 0.8, 1.2], 0.5e-3),
    (0.5, [0.8, 1.2, 0.8, 1.2], 0.5e-3),
    (0.15, [1.0; 4], 2e-3),
];

/// Worst and mean drift over seeded poses and slacks, rad, and the longest time, s.
fn worst(case: (f64, [f64; 4], f64), mut finger: ConfiguredFinger, rate: f64, take_up: &Activity) -> [f64; 3] {
    let (largest, ratio, friction) = case;
    finger.simulation.motor_constant_ratio = ratio;
    finger.simulation.joint_coulomb_friction = [friction; 3];
    let mut random = Pcg64::seed_from_u64(7);
    let homing = 0.03; // stretch of the tendons by the pretension, cm
    let mut found = [0.0f64; 3];
    for pose in poses() {
        finger.simulation.start_degrees = pose.map(f64::to_degrees).into();
        let slack = Vector4::from_fn(|_, _| homing + largest * f64::from(random.next_u32()) / 4294967296.0);
        let (drift, seconds) = drift(&finger, &slack, rate, take_up);
        found = [found[0].max(drift), found[1] + drift / 24.0, found[2].max(seconds)];
    }
    found
}

#[test]
fn the_joints_stay_where_they_are() {
    for (scheme, rate) in SCHEMES.into_iter().flat_map(|scheme| [500.0, 1000.0, 2000.0].map(|rate| (scheme, rate))) {
        let cases = if rate == 1000.0 { &CASES[..] } else { &CASES[3..5] };
        for &case in cases {
            let [drift, mean, seconds] = worst(case, finger_with(scheme), rate, &Activity::TakeUpSlack);
            println!("{scheme:?}, {rate} Hz, {case:?}: worst {drift:.3} rad, mean {mean:.3} rad, {seconds:.2} s");
            assert!(drift < 0.02 && mean < 0.01, "{scheme:?}, {rate} Hz, {case:?}: {drift} rad, mean {mean} rad");
        }
    }
}

#[test]
fn the_joints_stay_nearly_where_they_are_in_a_calibration() {
    for case in CASES {
        let tighten = Activity::Tighten(Vector4::zeros());
        let [drift, mean, _] = worst(case, finger_with(Scheme::Figure10), 1000.0, &tighten);
        assert!(drift < 0.1 && mean < 0.03, "{case:?}: {drift} rad, mean {mean} rad");
    }
}

/// If every tendon is pulled independently of the others, the same fingers drift. This shows that the test
/// `the_joints_stay_where_they_are` detects a drift.
#[test]
fn tendons_that_are_pulled_independently_move_the_joints() {
    let finger = ConfiguredFinger::default();
    let pretension = finger.tendons().expect("regular").pretension(finger.tendon.minimum);
    let [drift, mean, _] = worst(CASES[1], finger, 1000.0, &Activity::Tense(pretension));
    assert!(drift > 1.0 && mean > 0.3, "worst {drift} rad, mean {mean} rad");
}
