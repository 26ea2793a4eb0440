//! Trials of a finger that differs from its configuration: pushes, rest, steps, walls and bumps. The monitors of the
//! finger run during the trials.

use crate::cases::{Case, Friction, axes, direction, has_room};
use crate::closed_loop::{ClosedLoop, Held, Senses};
use crate::contact::{self, residual};
use crate::fits;
use crate::identification;
use crate::motion;
use crate::parallel::{each, worst};
use crate::truths::Truth;
use nalgebra::{Matrix3, Vector3};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng;
use sun2xp::model::configuration::ConfiguredFinger;

/// The stiffnesses of the trials, N/cm.
pub const SPRINGS: [f64; 2] = [3.0, 6.0];
/// Deflection of the pushes, cm.
const PUSHED: f64 = 0.2;

/// A sixth of the period of the dither, s, rounded to whole cycles of 1 ms.
const PHASE: f64 = 0.004;

/// The results of one pose.
#[derive(Clone, Debug, Default)]
pub struct Trial {
    /// Relative error of the stiffness for pushes of 2 mm, at each of [`SPRINGS`].
    pub error: [f64; 2],
    /// Motion at rest, cm rms, at each of [`SPRINGS`].
    pub rest: [f64; 2],
    /// Settling time of a step of 5 mm at 3 N/cm, s, and overshoot as a part of the step. Both are relative to the
    /// final position of the tip.
    pub settling: f64,
    pub overshoot: f64,
    /// Distance between the target and the final position of the tip, as a part of the step.
    pub off: f64,
    /// Largest motion at a wall, cm rms.
    pub wall: f64,
    /// Time after a bump until every tension is above half of t_min again, s: the longest of all bumps.
    pub bump: f64,
    /// The first fault of a monitor, with the trial in which it appeared.
    pub fault: Option<String>,
    /// Why identification was refused.
    pub refused: Option<String>,
}

/// Which trials run.
#[derive(Clone, Copy, PartialEq)]
pub enum Extent {
    /// Few and short trials of every kind, for a search.
    Search,
    /// Pushes, rest and steps.
    Short,
    /// Pushes, rest, steps, walls and bumps.
    All,
}

/// Runs the trials at every pose of each case. Returns the results of each case. `adjust` changes the finger and the
/// configuration of its controller, and `truth` then changes only the finger. If `identified` is set, each case
/// identifies the finger first, and its controllers use what was identified.
pub fn trials(
    cases: &[Case],
    truth: &Truth,
    identified: bool,
    extent: Extent,
    adjust: &(dyn Fn(&mut ConfiguredFinger) + Sync),
) -> Vec<Vec<Trial>> {
    let beliefs = each(cases, |_, case| {
        identified.then(|| {
            let mut finger = case.finger(&start(), Friction::Default);
            adjust(&mut finger);
            (truth.differ)(&mut finger);
            identification::identified(case, &finger)
        })
    });
    let poses: Vec<_> = cases
        .iter()
        .zip(&beliefs)
        .flat_map(|(case, belief)| {
            case.poses().into_iter().enumerate().map(move |(number, pose)| (case, belief, number, pose))
        })
        .collect();
    let mut all = each(&poses, |_, (case, belief, number, pose)| {
        let mut finger = case.finger(pose, Friction::Default);
        adjust(&mut finger);
        let mut known = finger.clone();
        (truth.differ)(&mut finger);
        match belief {
            Some(Err(obstacle)) => return Trial { refused: Some(obstacle.to_string()), ..Trial::default() },
            Some(Ok(found)) => {
                (known.tendon, known.friction, known.gauge, known.geometry) =
                    (found.tendon.clone(), found.friction.clone(), found.gauge.clone(), found.geometry.clone());
                known.motor = found.motor.clone();
            }
            None => {}
        }
        at_pose(case, *number, pose, &finger, &known, extent)
    });
    cases.iter().map(|case| all.drain(..case.poses).collect()).collect()
}

fn start() -> Vector3<f64> {
    Vector3::from(ConfiguredFinger::default().simulation.start_degrees.map(f64::to_radians))
}

fn at_pose(
    case: &Case,
    number: usize,
    pose: &Vector3<f64>,
    finger: &ConfiguredFinger,
    belief: &ConfiguredFinger,
    extent: Extent,
) -> Trial {
    let mut trial = Trial::default();
    let held = SPRINGS.map(|stiffness| {
        let kx = Matrix3::identity() * stiffness;
        ClosedLoop::new(&Held { case, finger, belief, pose, kx: &kx, senses: Senses::Counts })
    });
    for (index, held) in held.iter().enumerate() {
        trial.pushed(held, index, extent);
        let mut run = held.clone();
        run.run(0.5);
        trial.rest[index] = residual(&run.tips(if extent == Extent::Search { 0.5 } else { 1.0 }));
        trial.note(&run, "rest");
    }
    let mut random = Pcg64::seed_from_u64(case.seed + 100 + number as u64);
    let directions = (0..20).map(|_| direction(&mut random));
    for way in directions.filter(|way| has_room(finger, pose, way, 0.6)).take(2) {
        let mut run = held[0].clone();
        let step = motion::step(&mut run, &way);
        trial.settling = worst([trial.settling, step.to_its_end]);
        trial.overshoot = worst([trial.overshoot, step.beyond_its_end]);
        trial.off = worst([trial.off, step.off]);
        trial.note(&run, "step");
    }
    if extent != Extent::Short {
        trial.against_walls(&held);
        trial.bumped(&held[0], extent);
    }
    trial
}

/// The springs (index into [`SPRINGS`]) and the stiffnesses of the walls, N/cm.
const WALLS: [(usize, f64); 4] = [(0, 30.0), (0, 300.0), (1, 100.0), (1, 1000.0)];

impl Trial {
    fn note(&mut self, run: &ClosedLoop, what: &str) {
        if let (None, Some(alarm)) = (&self.fault, run.fault) {
            self.fault = Some(format!("{:?} ({what})", alarm));
        }
    }

    /// Pushes the tip both ways along every axis.
    fn pushed(&mut self, held: &ClosedLoop, index: usize, extent: Extent) {
        let (settled, averaged) = if extent == Extent::Search { (0.5, 0.3) } else { (0.8, 0.4) };
        let mut tip = |force: Vector3<f64>| {
            let mut run = held.clone();
            run.push(force);
            run.run(settled);
            let mean = run.mean_tip(averaged);
            self.note(&run, "push");
            mean
        };
        let (forces, deflections): (Vec<_>, Vec<_>) = [Vector3::x(), Vector3::y(), Vector3::z()]
            .into_iter()
            .map(|axis| {
                let force = axis * (SPRINGS[index] * PUSHED);
                (force, (tip(force) - tip(-force)) / 2.0)
            })
            .unzip();
        let kx = Matrix3::identity() * (SPRINGS[index] * held.report.stiffness_scale);
        self.error[index] = fits::spring_error(&forces, &deflections, &kx);
    }

    /// Moves the anchor into walls. Each kind of wall is on three of the six sides of the tip.
    fn against_walls(&mut self, held: &[ClosedLoop; 2]) {
        for (number, (spring, wall)) in WALLS.into_iter().enumerate() {
            for outward in axes().skip(number % 2).step_by(2) {
                let mut run = held[spring].clone();
                let tip = run.anchor();
                run.plant.set_surface(Some(contact::wall_off(&tip, &outward, wall)));
                if run.move_anchor(&(tip - outward * contact::INTO)) {
                    run.run(0.8);
                    self.wall = worst([self.wall, residual(&run.tips(0.3))]);
                    self.note(&run, "wall");
                }
            }
        }
    }

    fn bumped(&mut self, held: &ClosedLoop, extent: Extent) {
        let forces: &[f64] = if extent == Extent::Search { &[8.0] } else { &[4.0, 8.0] };
        for &force in forces {
            for (number, axis) in axes().enumerate() {
                let mut run = held.clone();
                // The bumps begin at six phases of the dither.
                run.run(PHASE * number as f64);
                run.push(axis * force);
                run.run(0.02);
                run.push(Vector3::zeros());
                let low = 0.5 * run.finger.tendon.minimum;
                let mut last = 0.0;
                for cycle in 1..=run.cycles(0.3) {
                    run.reset_extremes();
                    run.cycle();
                    if run.least_true < low {
                        last = cycle as f64 / run.rate;
                    }
                }
                self.bump = worst([self.bump, last]);
                self.note(&run, "bump");
            }
        }
    }
}
