//! Compares joint angles after zeroing with the true ones: for all named hands, for zeroing against the stops and at a
//! pose, and for random poses, zeros and seeds.

use crate::bench::Bench;
use nalgebra::{Vector3, Vector4};
use sun2xp::calibration::{Obstacle, Task};
use sun2xp::control::{Activity, SetPoint};
use sun2xp::model::configuration::{ConfiguredFinger, NamedHand, ZeroingMethod};

/// Largest error of a joint angle in the pose in which the finger was zeroed, degrees.
const PERMITTED: f64 = 0.1;

/// A number between -1 and 1.
fn random(seed: u64, index: u64) -> f64 {
    let mut x = (seed * 1000 + index + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (x >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// Joint angles, degrees, well within the limits.
fn pose(seed: u64, index: u64) -> [f64; 3] {
    [30.0 * random(seed, index), 35.0 + 30.0 * random(seed, index + 1), 60.0 + 30.0 * random(seed, index + 2)]
}

/// A finger, and what a new configuration says about it.
fn finger(hand: NamedHand, seed: u64, method: ZeroingMethod) -> (ConfiguredFinger, ConfiguredFinger) {
    let mut truth = ConfiguredFinger { simulation: hand.simulation(), ..ConfiguredFinger::default() };
    truth.simulation.seed = seed;
    truth.simulation.start_degrees = pose(seed, 90);
    truth.gauge.zero = std::array::from_fn(|gauge| 300.0 + 60.0 * random(seed, gauge as u64));
    truth.encoder.zero = std::array::from_fn(|motor| (50_000.0 * random(seed, 10 + motor as u64)) as i32);
    let mut belief = ConfiguredFinger::default();
    belief.gauge.zero = [300.0; 4];
    belief.zeroing.method = Some(method);
    belief.zeroing.pose_degrees = pose(seed, 70);
    (truth, belief)
}

fn motors_off(bench: &mut Bench, seconds: f64) {
    bench.run(seconds, &Activity::Turn(Vector4::zeros()));
}

/// Zeros the finger, which a person holds in its pose if the method is `Pose`.
fn zero(bench: &mut Bench) -> Result<(), Obstacle> {
    motors_off(bench, 0.2);
    let zeroing = bench.belief.zeroing.clone();
    if zeroing.method == Some(ZeroingMethod::Pose) {
        let (from, to) = (bench.plant.joints(), Vector3::from(zeroing.pose_degrees.map(f64::to_radians)));
        for step in 1..=50 {
            bench.plant.hold(from + (to - from) * f64::from(step) / 50.0);
            motors_off(bench, 0.02);
        }
        bench.plant.take_up_by_hand();
    }
    bench.follow_belief();
    bench.calibrate(Task::Zero)?;
    assert!(bench.largest_tension <= 60.0, "{} N", bench.largest_tension);
    motors_off(bench, 0.2);
    Ok(())
}

/// Makes the finger a spring, and returns its largest error of a joint angle, degrees. The error of each joint is
/// averaged over 0.5 s.
fn error(bench: &mut Bench) -> f64 {
    bench.follow_belief();
    bench.run(1.0, &Activity::TakeUpSlack);
    bench.plant.release();
    let follow = Activity::Follow(SetPoint::hard_finger(bench.report.joints, bench.belief.initial_stiffness()));
    bench.run(1.0, &follow);
    let cycles = 500;
    let mut sum = Vector3::zeros();
    for _ in 0..cycles {
        bench.run(1e-3, &follow);
        sum += bench.plant.joints() - bench.report.joints;
    }
    (sum / f64::from(cycles)).amax().to_degrees()
}

/// Errors after zeroing, after identification, and after the zeroing that follows it, degrees.
fn errors(hand: NamedHand, seed: u64, method: ZeroingMethod) -> Result<[f64; 3], Obstacle> {
    let (truth, belief) = finger(hand, seed, method);
    let mut bench = Bench::new(&truth, &belief, 1000.0);
    bench.calibrate(Task::Signs)?;
    zero(&mut bench)?;
    let zeroed = error(&mut bench);
    motors_off(&mut bench, 0.2);
    bench.follow_belief();
    bench.calibrate(Task::Identify)?;
    assert!(bench.largest_tension <= 60.0, "{} N", bench.largest_tension);
    motors_off(&mut bench, 0.2);
    let identified = error(&mut bench);
    zero(&mut bench)?;
    Ok([zeroed, identified, error(&mut bench)])
}

/// Prints the table of docs/calibration.md, and asserts that the errors after the last zeroing are small enough.
fn zeros_are_right(seeds: u64) {
    for method in [ZeroingMethod::Stops, ZeroingMethod::Pose] {
        for (number, hand) in (0..).zip(NamedHand::ALL) {
            let results: Vec<_> = (0..seeds).map(|seed| errors(hand, number + 4 * seed, method)).collect();
            results.iter().flat_map(|result| result.as_ref().err()).for_each(|obstacle| println!("    {obstacle}"));
            let accepted = || results.iter().flatten();
            let [zeroed, identified, again] =
                [0, 1, 2].map(|stage| accepted().map(|errors| errors[stage]).fold(0.0, f64::max));
            let (name, number) = (hand.name(), accepted().count());
            println!("| {name}, {method:?} | {number} of {seeds} | {zeroed:.3} | {identified:.3} | {again:.3} |");
            assert!(again <= PERMITTED, "{name}, {method:?}: {again} degrees");
            assert_eq!(number as u64, seeds, "{name}, {method:?}");
        }
    }
}

#[test]
fn zeros_after_calibration_are_right() {
    zeros_are_right(1);
}

#[test]
#[ignore = "long: 64 fingers, with four calibrations each"]
fn zeros_after_many_calibrations_are_right() {
    zeros_are_right(8);
}
