//! Rows that move the spring's anchor and look at how the tip follows.

use crate::cases::{Case, Friction, has_room};
use crate::closed_loop::ClosedLoop;
use nalgebra::Matrix3;

/// What a set of steps came to.
pub struct Steps {
    /// Time to stay within 5 %, s: worst and median.
    pub worst: f64,
    pub median: f64,
    /// Part of the step by which the tip goes beyond it, worst.
    pub overshoot: f64,
    /// N, true and commanded.
    pub least_true: f64,
    pub least_commanded: f64,
}

/// 5 mm, cm.
pub const STEP: f64 = 0.5;

/// Steps of the anchor by 5 mm from every pose in several directions, as far as the joint limits leave room.
pub fn steps(case: &Case, friction: Friction, stiffness: f64, loss: f64) -> Steps {
    let mut times = Vec::new();
    let mut steps =
        Steps { worst: 0.0, median: 0.0, overshoot: 0.0, least_true: f64::INFINITY, least_commanded: f64::INFINITY };
    for (number, pose) in case.poses().iter().enumerate() {
        for direction in case.directions(number) {
            let kx = Matrix3::identity() * stiffness;
            let mut finger = ClosedLoop::at(case, pose, friction, &kx);
            if !has_room(&finger.finger, pose, &direction, 1.2 * STEP) {
                continue;
            }
            finger.lose(loss);
            let target = finger.anchor() + direction * STEP;
            finger.move_anchor(&target);
            let mut settled = 0.0;
            for cycle in 1..=finger.cycles(1.5) {
                finger.cycle();
                let error = finger.plant.tip() - target;
                // Written so that NaN is not settled.
                if error.norm() > 0.05 * STEP || error.norm().is_nan() {
                    settled = cycle as f64 / finger.rate;
                }
                steps.overshoot = steps.overshoot.max(error.dot(&direction) / STEP);
            }
            times.push(settled);
            steps.least_true = steps.least_true.min(finger.least_true);
            steps.least_commanded = steps.least_commanded.min(finger.least_commanded);
        }
    }
    times.sort_by(f64::total_cmp);
    steps.median = times[times.len() / 2];
    steps.worst = times[times.len() - 1];
    steps
}

/// The distance of the tip from its target in the course of one step, part of the step, by cycle.
pub fn step_response(case: &Case, number: usize, stiffness: f64, seconds: f64) -> Vec<(f64, f64)> {
    let pose = case.poses()[number];
    let kx = Matrix3::identity() * stiffness;
    let mut finger = ClosedLoop::at(case, &pose, Friction::Default, &kx);
    let room = |direction: &nalgebra::Vector3<f64>| has_room(&finger.finger, &pose, direction, 1.2 * STEP);
    let direction = case.directions(number).into_iter().find(room).expect("a direction with room");
    let start = finger.anchor();
    finger.move_anchor(&(start + direction * STEP));
    (0..finger.cycles(seconds))
        .map(|cycle| {
            finger.cycle();
            (cycle as f64 / case.rate, (finger.plant.tip() - start).dot(&direction) / STEP)
        })
        .collect()
}

/// A reach of 30 mm over 200 ms, minimum jerk, Kx 3: the largest error from 100 ms after its end on, cm, and the least true tension,
/// N.
pub fn reach(case: &Case) -> (f64, f64) {
    const WAY: f64 = 3.0;
    let (mut farthest, mut least): (f64, f64) = (0.0, f64::INFINITY);
    for (number, pose) in case.poses().iter().enumerate() {
        for direction in case.directions(number) {
            let mut finger = ClosedLoop::at(case, pose, Friction::Default, &(Matrix3::identity() * 3.0));
            if !has_room(&finger.finger, pose, &direction, WAY) {
                continue;
            }
            let start = finger.anchor();
            let cycles = finger.cycles(0.2);
            for cycle in 1..=cycles {
                let part = cycle as f64 / cycles as f64;
                let way = WAY * part.powi(3) * (10.0 - 15.0 * part + 6.0 * part * part);
                finger.move_anchor(&(start + direction * way));
                finger.cycle();
            }
            finger.run(0.1);
            for _ in 0..finger.cycles(0.3) {
                farthest = farthest.max((finger.plant.tip() - finger.anchor()).norm());
                finger.cycle();
            }
            least = least.min(finger.least_true);
        }
    }
    (farthest, least)
}
