//! Measurements of how the tip follows the spring's anchor, for the tables of docs/stiffness.md.

use crate::cases::{Case, Friction};
use crate::closed_loop::{ClosedLoop, Held, Senses};
use crate::contact::residual;
use crate::parallel::{each, least, worst};
use nalgebra::{Matrix3, Vector3, Vector4};
use sun2xp::model::configuration::ConfiguredFinger;

/// The results of a set of steps.
pub struct Steps {
    /// Time until the distance of the tip from its target stays within 5 % of the step, s: worst and median.
    pub worst: f64,
    pub median: f64,
    /// Worst overshoot, as a part of the step.
    pub overshoot: f64,
    /// Smallest true and commanded tension, N.
    pub least_true: f64,
    pub least_commanded: f64,
}

/// Length of a step, cm.
pub const STEP: f64 = 0.5;
/// Distance that the joint limits must leave free for a step, cm, so that an overshoot does not reach them.
pub const ROOM: f64 = 1.2 * STEP;
/// Duration of a step, s. A step that has not settled by then counts with this time.
const WATCHED: f64 = 1.5;
/// Length of the last part of a step, over which the position of the tip is averaged, s.
const ENDING: f64 = 0.2;

/// The result of one step.
pub struct Step {
    /// Time until the distance of the tip from its target stays within 5 % of [`STEP`], s.
    pub time: f64,
    /// Time until the distance of the tip from its final position stays within 5 % of [`STEP`], s.
    pub to_its_end: f64,
    /// Distance of the final position from the target, as a part of the step.
    pub off: f64,
    /// Overshoot beyond the target and beyond the final position, as parts of the step.
    pub overshoot: f64,
    pub beyond_its_end: f64,
    least_true: f64,
    least_commanded: f64,
}

/// Steps the anchor by 5 mm from every pose, in each of several directions in which the joint limits leave room.
/// `stiffness` is in N/cm, and `loss` is the probability with which a reply is lost.
pub fn steps(case: &Case, stiffness: f64, loss: f64) -> Steps {
    steps_of(case, stiffness, loss, |_| {})
}

/// Does the same as [`steps`], but first changes each finger with `differ`. Its controller has the unchanged
/// configuration.
pub fn steps_of(case: &Case, stiffness: f64, loss: f64, differ: impl Fn(&mut ConfiguredFinger) + Sync) -> Steps {
    let kx = Matrix3::identity() * stiffness;
    let all = each(&case.poses_and_directions(ROOM), |_, (pose, direction)| {
        let belief = case.finger(pose, Friction::Default);
        let mut finger = belief.clone();
        differ(&mut finger);
        let (finger, belief) = (&finger, &belief);
        let mut run = ClosedLoop::new(&Held { case, finger, belief, pose, kx: &kx, senses: Senses::Counts });
        run.lose(loss);
        step(&mut run, direction)
    });
    let mut times: Vec<f64> = all.iter().map(|step| step.time).collect();
    times.sort_by(f64::total_cmp);
    Steps {
        worst: times[times.len() - 1],
        median: times[times.len() / 2],
        overshoot: worst(all.iter().map(|step| step.overshoot)),
        least_true: least(all.iter().map(|step| step.least_true)),
        least_commanded: least(all.iter().map(|step| step.least_commanded)),
    }
}

/// Steps the anchor by 5 mm in a direction that has room.
pub fn step(finger: &mut ClosedLoop, direction: &Vector3<f64>) -> Step {
    let target = finger.anchor() + direction * STEP;
    assert!(finger.move_anchor(&target), "a direction with room");
    let tips = finger.tips(WATCHED);
    let last = &tips[tips.len() - finger.cycles(ENDING)..];
    let end = last.iter().sum::<Vector3<f64>>() / last.len() as f64;
    Step {
        time: settling_time(&tips, &target, finger.rate),
        to_its_end: settling_time(&tips, &end, finger.rate),
        off: (end - target).norm() / STEP,
        overshoot: worst(tips.iter().map(|tip| (tip - target).dot(direction) / STEP)),
        beyond_its_end: worst(tips.iter().map(|tip| (tip - end).dot(direction) / STEP)),
        least_true: finger.least_true,
        least_commanded: finger.least_commanded,
    }
}

/// Returns the time from which the distance of the tip from `target` stays within 5 % of [`STEP`], s.
fn settling_time(tips: &[Vector3<f64>], target: &Vector3<f64>, rate: f64) -> f64 {
    // NaN counts as not settled.
    let settled = |tip: &Vector3<f64>| (tip - target).norm() <= 0.05 * STEP;
    tips.iter().rposition(|tip| !settled(tip)).map_or(0.0, |last| (last + 1) as f64 / rate)
}

/// Steps the anchor from every pose in the first direction that the joint limits permit. Returns the motion of the tip
/// for each step, as pairs. A pair consists of the time, s, and the distance along the step, as a part of the step.
pub fn step_responses(case: &Case, stiffness: f64, seconds: f64) -> Vec<Vec<(f64, f64)>> {
    let mut cases = case.poses_and_directions(ROOM);
    cases.dedup_by_key(|(pose, _)| *pose);
    each(&cases, |_, (pose, direction)| {
        let mut finger = ClosedLoop::at(case, pose, Friction::Default, &(Matrix3::identity() * stiffness));
        let start = finger.anchor();
        assert!(finger.move_anchor(&(start + direction * STEP)), "a direction with room");
        let tips = finger.tips(seconds);
        let gone = |(cycle, tip): (usize, &Vector3<f64>)| {
            ((cycle + 1) as f64 / case.rate, (tip - start).dot(direction) / STEP)
        };
        tips.iter().enumerate().map(gone).collect()
    })
}

/// Moves the anchor by 30 mm in 200 ms with minimum jerk, at a Kx of 3 N/cm. Returns the largest error from 100 ms to
/// 400 ms after the end of the motion, cm, and the smallest true tension, N.
pub fn reach(case: &Case) -> (f64, f64) {
    const WAY: f64 = 3.0;
    let all = each(&case.poses_and_directions(WAY), |_, (pose, direction)| {
        let mut finger = ClosedLoop::at(case, pose, Friction::Default, &(Matrix3::identity() * 3.0));
        let start = finger.anchor();
        let cycles = finger.cycles(0.2);
        for cycle in 1..=cycles {
            let part = cycle as f64 / cycles as f64;
            let way = WAY * part.powi(3) * (10.0 - 15.0 * part + 6.0 * part * part);
            assert!(finger.move_anchor(&(start + direction * way)), "a direction with room");
            finger.cycle();
        }
        finger.run(0.1);
        let anchor = finger.anchor();
        (worst(finger.tips(0.3).iter().map(|tip| (tip - anchor).norm())), finger.least_true)
    });
    (worst(all.iter().map(|one| one.0)), least(all.iter().map(|one| one.1)))
}

/// Holds a pose, with friction. Returns the change of a tendon's commanded pull per cycle, N rms, and the motion of the
/// tip, cm rms. Both are the worst of all poses and tendons.
pub fn at_rest(case: &Case, stiffness: f64) -> (f64, f64) {
    let all = each(&case.poses(), |_, pose| {
        let mut finger = ClosedLoop::at(case, pose, Friction::Default, &(Matrix3::identity() * stiffness));
        finger.run(0.5);
        let radius = Vector4::from(finger.finger.geometry.motor_radius);
        let cycles = finger.cycles(1.0);
        let (mut changes, mut tips) = (Vector4::<f64>::zeros(), Vec::with_capacity(cycles));
        for _ in 0..cycles {
            let before = finger.report.motor_torques;
            finger.cycle();
            let change = (finger.report.motor_torques - before).component_div(&radius);
            changes += change.component_mul(&change);
            tips.push(finger.plant.tip());
        }
        ((changes.max() / cycles as f64).sqrt(), residual(&tips))
    });
    (worst(all.iter().map(|one| one.0)), worst(all.iter().map(|one| one.1)))
}
