//! Rows in which the controller believes something that is not so.

use crate::cases::{Case, Friction};
use crate::closed_loop::ClosedLoop;
use crate::motion::STEP;
use nalgebra::{Matrix3, Vector3};
use sun2xp::model::configuration::ConfiguredFinger;

/// Error of the deflection by 1 mm, worst over poses and axes, and the worst time of a 5 mm step, s, where the true finger is not what
/// the controller believes. Kx 3, no friction.
pub fn believing_otherwise(case: &Case, differ: impl Fn(&mut ConfiguredFinger)) -> f64 {
    const DEFLECTION: f64 = 0.1;
    let kx = Matrix3::identity() * 3.0;
    let mut worst: f64 = 0.0;
    for pose in case.poses() {
        let belief = case.finger(&pose, Friction::None);
        let mut finger = belief.clone();
        differ(&mut finger);
        for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
            let pushed = |force: Vector3<f64>| {
                let mut run = ClosedLoop::with_belief(case, &finger, &belief, &pose, &kx);
                run.push(force);
                run.run(1.0);
                run.mean_tip(1.0)
            };
            let force = axis * (3.0 * DEFLECTION);
            let moved = (pushed(force) - pushed(-force)) / 2.0;
            worst = worst.max((moved - axis * DEFLECTION).norm() / DEFLECTION);
        }
    }
    worst
}

/// Motors that give 20 % more or less than their commands, each finger's four in a pattern.
pub fn motor_constants(finger: &mut ConfiguredFinger) {
    finger.simulation.motor_constant_ratio = [1.2, 0.8, 1.2, 0.8];
}

/// Tendons that are 10 % stiffer than believed.
pub fn tendon_stiffness(finger: &mut ConfiguredFinger) {
    finger.simulation.tendon_stiffness = finger.simulation.tendon_stiffness.map(|stiffness| 1.1 * stiffness);
}

/// Tendons whose stiffness is known to 2 %, as after calibration.
pub fn calibrated(finger: &mut ConfiguredFinger) {
    let factors = [1.02, 0.98, 1.02, 0.98];
    for (stiffness, factor) in finger.simulation.tendon_stiffness.iter_mut().zip(factors) {
        *stiffness *= factor;
    }
}

/// The largest growth of a deviation a cycle, |lambda| of the one-cycle map: two runs of the same frictionless finger, one of them
/// nudged; their difference shrinks by the largest eigenvalue each cycle once the others have died away. Sensors are quantised
/// finely enough not to matter. Worst over poses and springs.
pub fn growth(case: &Case) -> f64 {
    let mut worst: f64 = 0.0;
    for pose in case.poses() {
        for kx in case.springs() {
            let g = growth_at(case, &pose, &kx);
            eprintln!("DBG {g:.4} {:?} {:?}", pose.map(f64::to_degrees).as_slice(), kx.diagonal().as_slice());
            worst = worst.max(g);
        }
    }
    worst
}

fn growth_at(case: &Case, pose: &Vector3<f64>, kx: &Matrix3<f64>) -> f64 {
    let mut finger = case.finger(pose, Friction::None);
    finger.simulation.gauge_noise = 0.0;
    // Fine enough for the deviation to be seen through all of the time below: 1 mN, about the pretension that the finger rests
    // with. The gauges' 12 bits then reach 2 N to both sides.
    finger.encoder.counts_per_revolution = [4_000_000; 4];
    finger.gauge.newton_per_count = [1e-3; 4];
    let rest = finger.tendons().expect("the default finger").pretension(finger.tendon.minimum);
    finger.gauge.zero = rest.map(|tension| 2048.0 - tension / 1e-3).into();
    let run = |nudge: f64| {
        let mut run = ClosedLoop::with_belief(case, &finger, &finger, pose, kx);
        run.push(Vector3::new(1.0, -1.0, 1.0) * nudge);
        run.run(0.02);
        run.push(Vector3::zeros());
        run
    };
    let (mut still, mut nudged) = (run(0.0), run(0.3 * STEP));
    // The largest difference within 50 ms, and within 50 ms that come 200 ms later.
    let mut window = |seconds: f64| {
        let mut largest: f64 = 0.0;
        for _ in 0..still.cycles(seconds) {
            still.cycle();
            nudged.cycle();
            largest = largest.max((still.plant.tip() - nudged.plant.tip()).norm());
        }
        largest
    };
    let early = window(0.05);
    let _ = window(0.15);
    let late = window(0.05);
    (late / early).powf(1.0 / (0.2 * case.rate))
}
