//! Measures the error of the estimated contact torques for contacts that begin near the end of a motion.
//!
//! The torques are compared, and not the force at the tip. Near a singular pose, the estimate of the force along the
//! finger goes to zero, whatever the motion was.

use crate::cases::Case;
use crate::finger::{Finger, RATE};
use crate::motion::Motion;
use crate::parallel::{each, worst};
use nalgebra::Vector3;
use std::error::Error;
use sun2xp::model::configuration::ConfiguredContact;

/// The force of each push, N.
pub const FORCE: f64 = 1.0;

/// Times from the end of the motion of the set point to the push, s. A negative time is before the end.
pub const DELAYS: [f64; 5] = [-0.1, 0.0, 0.05, 0.2, 1.0];

/// Time for which a push acts after the end of the motion, s.
const PUSH: f64 = 0.5;
/// Duration of the last part of a push, in which the estimate is compared, s.
const COMPARED: f64 = 0.2;

/// Duration of the rest at the beginning of a run, and longest additional rest before each motion, s.
const REST: f64 = 1.0;

/// Shortest and longest motion, s.
const MOTION: (f64, f64) = (0.3, 1.8);

/// Number of pushes for each delay and seed.
const PUSHES: usize = 10;

/// A push: the index of its delay in [`DELAYS`], whether it was detected, and the error, N cm.
type Push = (usize, bool, f64);

/// The pushes with one delay.
#[derive(Default)]
pub struct After {
    pub pushes: usize,
    pub noticed: usize,
    /// Sum of the errors of the pushes, and the largest of them, N cm. The error of a push is the largest of the mean
    /// errors of the joint torques.
    pub sum: f64,
    pub worst: f64,
}

/// Moves a finger at up to `speed`, rad/s, and pushes it shortly before or after the end of each motion.
pub fn measure(case: &Case, contact: &ConfiguredContact, seeds: u64, speed: f64) -> Result<Vec<After>, Box<dyn Error>> {
    let seeds: Vec<u64> = (0..seeds).collect();
    let runs = each(&seeds, |_, &seed| pushes(case, contact, seed, speed).map_err(|error| error.to_string()));
    let mut all: Vec<After> = DELAYS.iter().map(|_| After::default()).collect();
    for run in runs {
        for (place, noticed, error) in run? {
            let after = &mut all[place];
            after.pushes += 1;
            after.noticed += usize::from(noticed);
            after.sum += error;
            after.worst = worst([after.worst, error]);
        }
    }
    Ok(all)
}

/// Returns the pushes of a finger.
fn pushes(case: &Case, contact: &ConfiguredContact, seed: u64, speed: f64) -> Result<Vec<Push>, Box<dyn Error>> {
    let (finger, belief) = case.finger(contact, seed);
    let start = Vector3::from(finger.simulation.start_degrees.map(f64::to_radians));
    let mut run = Finger::new(&finger, &belief, case.gravity)?;
    let mut motion = Motion::new(seed, finger.joint_limits(), start).without_rests();
    let mut random = Motion::new(seed + 1000, finger.joint_limits(), start);
    rest(&mut run, &motion, REST);
    let mut found = Vec::new();
    for _ in 0..PUSHES {
        for (place, delay) in DELAYS.into_iter().enumerate() {
            rest(&mut run, &motion, REST * random.uniform());
            let seconds = MOTION.0 + (MOTION.1 - MOTION.0) * random.uniform();
            let force = Vector3::from_fn(|_, _| random.uniform() - 0.5).normalize() * FORCE;
            let (noticed, error) = push_after(&mut run, &mut motion, speed, (seconds, delay), force);
            found.push((place, noticed, error));
        }
    }
    Ok(found)
}

fn rest(run: &mut Finger, motion: &Motion, seconds: f64) {
    for _ in 0..(seconds * RATE) as usize {
        run.cycle(motion.joints);
    }
}

/// Moves for `seconds`, and begins the push `delay` seconds after the end of the motion, or before it if `delay` is
/// negative. Returns whether the push was detected, and the error.
fn push_after(
    run: &mut Finger,
    motion: &mut Motion,
    speed: f64,
    (seconds, delay): (f64, f64),
    force: Vector3<f64>,
) -> (bool, f64) {
    let [moving, begin] = [seconds, seconds + delay].map(|time| (time * RATE) as usize);
    let end = moving.max(begin) + (PUSH * RATE) as usize;
    let compared = end - (COMPARED * RATE) as usize;
    let (mut noticed, mut difference) = (false, Vector3::zeros());
    for cycle in 0..end {
        if cycle == begin {
            run.plant.set_external_force(force);
        }
        let set_point = if cycle < moving { motion.set_point(speed, 1.0 / RATE) } else { motion.joints };
        let estimate = run.cycle(set_point).contact;
        noticed |= cycle >= begin && estimate.touching;
        if cycle >= compared {
            let jacobian = run.plant.links().jacobian(&run.plant.joints());
            difference += estimate.torques - jacobian.tr_mul(&force);
        }
    }
    run.plant.set_external_force(Vector3::zeros());
    (noticed, difference.amax() / (end - compared) as f64)
}
