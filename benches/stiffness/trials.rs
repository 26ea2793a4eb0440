//! Trials of a finger that differs from its configuration: pushes, rest, steps, walls and bumps, with its monitors.

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

/// The results of one pose.
#[derive(Clone, Debug, Default)]
pub struct Trial {
    /// Error of K for pushes of 2 mm, at each of [`SPRINGS`].
    pub error: [f64; 2],
    /// Motion at rest, cm rms, at each of [`SPRINGS`].
    pub rest: [f64; 2],
    /// Settling time of a step of 5 mm at 3 N/cm, s, and overshoot as a part of the step.
    pub settling: f64,
    pub overshoot: f64,
    /// Largest motion at a wall, cm rms.
    pub wall: f64,
    /// Time after a bump until every tension is above half of t_min again, s: the longer of two bumps.
    pub bump: f64,
    /// The first fault of a monitor, with the trial in which it appeared.
    pub fault: Option<String>,
    /// Why identification was refused.
    pub refused: Option<String>,
}

/// Which trials run.
#[derive(Clone, Copy, PartialEq)]
pub enum Extent {
    /// Pushes, rest and steps.
    Short,
    /// Walls and bumps too.
    All,
}

/// Runs the trials at every pose of a case.
pub fn trials(
    case: &Case,
    truth: &Truth,
    identified: bool,
    extent: Extent,
    adjust: &(dyn Fn(&mut ConfiguredFinger) + Sync),
) -> Vec<Trial> {
    let belief = identified.then(|| {
        let mut finger = case.finger(&start(), Friction::Default);
        (truth.differ)(&mut finger);
        adjust(&mut finger);
        identification::identified(case, &finger)
    });
    each(&case.poses(), |number, pose| {
        let mut finger = case.finger(pose, Friction::Default);
        adjust(&mut finger);
        let mut known = finger.clone();
        (truth.differ)(&mut finger);
        match &belief {
            Some(Err(obstacle)) => return Trial { refused: Some(obstacle.to_string()), ..Trial::default() },
            Some(Ok(found)) => {
                (known.tendon, known.friction, known.gauge, known.geometry) =
                    (found.tendon.clone(), found.friction.clone(), found.gauge.clone(), found.geometry.clone());
            }
            None => {}
        }
        at_pose(case, number, pose, &finger, &known, extent)
    })
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
    let held = |stiffness: f64| {
        let kx = Matrix3::identity() * stiffness;
        ClosedLoop::new(&Held { case, finger, belief, pose, kx: &kx, senses: Senses::Counts })
    };
    for (index, stiffness) in SPRINGS.into_iter().enumerate() {
        let rest = held(stiffness);
        let mut tip = |force: Vector3<f64>| {
            let mut run = rest.clone();
            run.push(force);
            run.run(1.0);
            let mean = run.mean_tip(0.5);
            trial.note(&run, "push");
            mean
        };
        let (forces, deflections): (Vec<_>, Vec<_>) = [Vector3::x(), Vector3::y(), Vector3::z()]
            .into_iter()
            .map(|axis| {
                let force = axis * (stiffness * PUSHED);
                (force, (tip(force) - tip(-force)) / 2.0)
            })
            .unzip();
        let kx = Matrix3::identity() * (stiffness * rest.report.stiffness_scale);
        trial.error[index] = fits::spring_error(&forces, &deflections, &kx);
        let mut run = rest.clone();
        run.run(0.7);
        trial.rest[index] = residual(&run.tips(1.5));
        trial.note(&run, "rest");
    }
    let mut random = Pcg64::seed_from_u64(case.seed + 100 + number as u64);
    let directions = (0..20).map(|_| direction(&mut random));
    for way in directions.filter(|way| has_room(finger, pose, way, 0.6)).take(2) {
        let mut run = held(3.0);
        let step = motion::step(&mut run, &way);
        trial.settling = worst([trial.settling, step.time]);
        trial.overshoot = worst([trial.overshoot, step.overshoot]);
        trial.note(&run, "step");
    }
    if extent == Extent::All {
        trial.against_walls(&held);
        trial.bumped(&held);
    }
    trial
}

impl Trial {
    fn note(&mut self, run: &ClosedLoop, what: &str) {
        if let (None, Some(alarm)) = (&self.fault, run.fault) {
            self.fault = Some(format!("{:?} ({what})", alarm));
        }
    }

    fn against_walls(&mut self, held: &impl Fn(f64) -> ClosedLoop) {
        for (stiffness, wall) in [(3.0, 30.0), (3.0, 300.0), (6.0, 100.0), (6.0, 1000.0)] {
            for outward in axes() {
                let mut run = held(stiffness);
                let tip = run.anchor();
                run.plant.set_surface(Some(contact::wall_off(&tip, &outward, wall)));
                if run.move_anchor(&(tip - outward * contact::INTO)) {
                    run.run(1.2);
                    self.wall = worst([self.wall, residual(&run.tips(0.4))]);
                    self.note(&run, "wall");
                }
            }
        }
    }

    fn bumped(&mut self, held: &impl Fn(f64) -> ClosedLoop) {
        for force in [4.0, 8.0] {
            for axis in axes() {
                let mut run = held(3.0);
                run.push(axis * force);
                run.run(0.02);
                run.push(Vector3::zeros());
                let low = 0.5 * run.finger.tendon.minimum;
                let mut last = 0.0;
                for cycle in 1..=run.cycles(0.5) {
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
