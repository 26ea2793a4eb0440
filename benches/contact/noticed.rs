//! Measures which forces are detected, at rest and in motion, and the time until they are detected.

use crate::cases::Case;
use crate::finger::{Finger, RATE};
use crate::motion::Motion;
use crate::parallel::{each, worst};
use nalgebra::Vector3;
use std::error::Error;
use sun2xp::model::configuration::ConfiguredContact;

/// The forces of the pushes, N.
pub const FORCES: [f64; 10] = [0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 1.0, 1.5, 2.0, 3.0];

/// Poses at rest, degrees.
const POSES: [[f64; 3]; 5] =
    [[0.0, 30.0, 60.0], [40.0, 60.0, 90.0], [-40.0, 0.0, 30.0], [20.0, 80.0, 100.0], [-20.0, -10.0, 45.0]];

/// Duration of a push, s.
const PUSH: f64 = 0.4;

/// Time before the first push, s.
const SETTLING: f64 = 1.0;

/// Fastest joint rate in motion, rad/s.
const SPEED: f64 = 1.0;

/// The results of all pushes with one force.
#[derive(Default)]
pub struct Pushes {
    pub pushes: usize,
    pub noticed: usize,
    /// Times from the beginning of a push until the contact is reported, s, sorted.
    pub times: Vec<f64>,
    /// Times from the end of a push until the contact is lost, s, sorted.
    pub losses: Vec<f64>,
    /// Largest error of the estimated force at the end of a detected push, N.
    pub error: f64,
}

impl Pushes {
    fn add(&mut self, push: &Push) {
        self.pushes += 1;
        if let Some(time) = push.noticed {
            self.noticed += 1;
            self.times.push(time);
            self.losses.push(push.lost);
            self.error = worst([self.error, push.error]);
        }
    }
}

/// The result of one push.
struct Push {
    /// Time from its beginning until the contact was reported, s; none if it was not reported.
    noticed: Option<f64>,
    /// Time from its end until the contact was lost, s.
    lost: f64,
    /// Error of the estimated force at its end, N.
    error: f64,
}

/// Pushes a resting finger with every force, in every pose, from six directions, once for each of `seeds` seeds of the
/// simulation.
pub fn at_rest(case: &Case, contact: &ConfiguredContact, seeds: u64) -> Result<Vec<Pushes>, Box<dyn Error>> {
    let cases: Vec<_> = (0..seeds).flat_map(|seed| POSES.map(|pose| (seed, pose))).collect();
    let runs = each(&cases, |_, &(seed, pose)| {
        let (mut finger, belief) = case.finger(contact, seed);
        finger.simulation.start_degrees = pose;
        let pose = Vector3::from(pose.map(f64::to_radians));
        let mut run = Finger::new(&finger, &belief, case.gravity).map_err(|error| error.to_string())?;
        wait(&mut run, SETTLING, || pose);
        let mut pushes = Vec::new();
        for (level, force) in FORCES.into_iter().enumerate() {
            for direction in 0..6 {
                let mut push = Vector3::zeros();
                push[direction % 3] = if direction < 3 { force } else { -force };
                pushes.push((level, push_once(&mut run, push, || pose)));
            }
        }
        Ok(pushes)
    });
    collected(runs)
}

/// Pushes a moving finger with every force in random directions, six times for each of `seeds` seeds.
pub fn in_motion(case: &Case, contact: &ConfiguredContact, seeds: u64) -> Result<Vec<Pushes>, Box<dyn Error>> {
    let seeds: Vec<u64> = (0..seeds).collect();
    let runs = each(&seeds, |_, &seed| {
        let (finger, belief) = case.finger(contact, seed);
        let start = Vector3::from(finger.simulation.start_degrees.map(f64::to_radians));
        let mut run = Finger::new(&finger, &belief, case.gravity).map_err(|error| error.to_string())?;
        let mut motion = Motion::new(seed, finger.joint_limits(), start).without_rests();
        let mut directions = Motion::new(seed + 1000, finger.joint_limits(), start);
        wait(&mut run, SETTLING, || motion.set_point(SPEED, 1.0 / RATE));
        let mut pushes = Vec::new();
        for _ in 0..6 {
            for (level, force) in FORCES.into_iter().enumerate() {
                let direction = Vector3::from_fn(|_, _| directions.uniform() - 0.5).normalize();
                wait(&mut run, directions.uniform(), || motion.set_point(SPEED, 1.0 / RATE));
                pushes.push((level, push_once(&mut run, direction * force, || motion.set_point(SPEED, 1.0 / RATE))));
            }
        }
        Ok(pushes)
    });
    collected(runs)
}

fn collected(runs: Vec<Result<Vec<(usize, Push)>, String>>) -> Result<Vec<Pushes>, Box<dyn Error>> {
    let mut all: Vec<Pushes> = FORCES.iter().map(|_| Pushes::default()).collect();
    for run in runs {
        for (level, push) in run? {
            all[level].add(&push);
        }
    }
    for pushes in &mut all {
        pushes.times.sort_by(f64::total_cmp);
        pushes.losses.sort_by(f64::total_cmp);
    }
    Ok(all)
}

fn wait(run: &mut Finger, seconds: f64, mut joints: impl FnMut() -> Vector3<f64>) {
    for _ in 0..(seconds * RATE) as usize {
        run.cycle(joints());
    }
}

/// Pushes once, and then waits for the same time without a force.
fn push_once(run: &mut Finger, force: Vector3<f64>, mut joints: impl FnMut() -> Vector3<f64>) -> Push {
    let cycles = (PUSH * RATE) as usize;
    run.plant.set_external_force(force);
    let mut push = Push { noticed: None, lost: PUSH, error: 0.0 };
    for cycle in 1..=cycles {
        let contact = run.cycle(joints()).contact;
        if contact.touching && push.noticed.is_none() {
            push.noticed = Some(cycle as f64 / RATE);
        }
        push.error = (contact.force - force).norm();
    }
    run.plant.set_external_force(Vector3::zeros());
    let mut last = 0;
    for cycle in 1..=cycles {
        if run.cycle(joints()).contact.touching {
            last = cycle;
        }
    }
    push.lost = last as f64 / RATE;
    push
}
