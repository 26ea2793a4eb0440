//! Zeroing at a pose, over many poses, seeds, zeros and disturbances: every accepted result must be correct.

use crate::bench::Bench;
use nalgebra::{Vector3, Vector4};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use sun2xp::calibration::{Findings, Obstacle, Task};
use sun2xp::control::{Activity, SetPoint};
use sun2xp::model::configuration::{ConfiguredFinger, Scheme, ZeroingMethod};
use sun2xp::plant::Plant;

/// Largest joint angle error after an accepted zeroing, rad.
const ACCEPTED: f64 = 0.005;

const SCHEMES: [Scheme; 2] = [Scheme::StateFeedback, Scheme::Figure10];

/// The random values of one seed.
struct Chance(Pcg64);

impl Chance {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn direction(&mut self) -> Vector3<f64> {
        loop {
            let candidate = Vector3::from_fn(|_, _| self.between(-1.0, 1.0));
            if (0.1..1.0).contains(&candidate.norm()) {
                return candidate.normalize();
            }
        }
    }
}

/// A finger at a random pose within its limits, whose controller has wrong zeros.
struct Trial {
    chance: Chance,
    truth: ConfiguredFinger,
    belief: ConfiguredFinger,
    gravity: Vector3<f64>,
}

impl Trial {
    fn new(scheme: Scheme, seed: u64) -> Self {
        let mut chance = Chance(Pcg64::seed_from_u64(seed));
        let mut truth = ConfiguredFinger::default();
        truth.controller.scheme = Some(scheme);
        truth.zeroing.method = Some(ZeroingMethod::Pose);
        truth.simulation.seed = seed;
        let (low, high) = truth.joint_limits();
        for joint in 0..3 {
            let angle = chance.between(low[joint] + 0.2, high[joint] - 0.2);
            truth.simulation.start_degrees[joint] = angle.to_degrees();
        }
        let mut belief = truth.clone();
        for tendon in 0..4 {
            // The errors correspond to some hundredths of a radian at a joint, and to one newton.
            belief.encoder.zero[tendon] += chance.between(-300.0, 300.0) as i32;
            truth.gauge.zero[tendon] = 220.0;
            belief.gauge.zero[tendon] = 220.0 + chance.between(-40.0, 40.0);
        }
        let gravity = chance.direction() * chance.between(0.0, 9.81);
        Self { chance, truth, belief, gravity }
    }

    /// The motors are off, and a person holds the finger.
    fn limp(&self) -> Bench {
        let mut bench = Bench::in_gravity(&self.truth, &self.belief, self.gravity, 1000.0);
        bench.plant.hold(bench.plant.joints());
        bench.run(0.2, &Activity::Turn(Vector4::zeros()));
        bench
    }

    /// A spring that holds the finger's pose.
    fn spring(&self) -> Bench {
        let mut bench = Bench::in_gravity(&self.truth, &self.belief, self.gravity, 1000.0).open();
        // The wrong zeros of the gauges make the finger move away from its set point. A compliant finger, or one
        // whose tip is near the axis of joint 0, moves slowly. So the spring gets 4 s for this motion.
        bench.go_on(4.0);
        bench
    }

    /// Zeroes the finger. The routine is given the pose that the finger has by then.
    fn zero(&self, bench: &mut Bench, happen: impl FnMut(f64, &mut Plant)) -> Result<f64, Obstacle> {
        bench.belief.zeroing.pose_degrees = bench.plant.joints().map(f64::to_degrees).into();
        let found = bench.calibrate_with(Task::Zero, happen)?;
        let Findings::Zeros(found) = found else { panic!("{found:?}") };
        let finger = &self.truth;
        let tendons = finger.tendons().expect("tendons");
        let off = Vector4::from_fn(|motor, _| {
            let counts = f64::from(found.encoder[motor] - finger.encoder.zero[motor]);
            counts * std::f64::consts::TAU / f64::from(finger.encoder.counts_per_revolution[motor])
                * tendons.radius[motor]
        });
        Ok((tendons.joints_from_travel() * off).amax())
    }
}

/// Results of many trials. Every accepted result must be correct.
struct Tally {
    accepted: usize,
    refused: Vec<(u64, Obstacle)>,
}

impl Tally {
    fn of(what: &str, seeds: u64, mut trial: impl FnMut(u64) -> Result<f64, Obstacle>) -> Self {
        let (mut errors, mut refused) = (Vec::new(), Vec::new());
        for seed in 0..seeds {
            match trial(seed) {
                Ok(error) => errors.push(error),
                Err(obstacle) => refused.push((seed, obstacle)),
            }
        }
        errors.sort_by(f64::total_cmp);
        let median = errors.get(errors.len() / 2).copied().unwrap_or_default();
        let worst = errors.last().copied().unwrap_or_default();
        println!(
            "{what}: {} accepted, off by {median:.5} rad in the median, {worst:.5} at worst, {} refused",
            errors.len(),
            refused.len()
        );
        assert!(worst <= ACCEPTED, "{what}: {worst} rad");
        Self { accepted: errors.len(), refused }
    }

    fn only_refused(&self, is_expected: impl Fn(&Obstacle) -> bool) {
        let other = self.refused.iter().find(|(_, obstacle)| !is_expected(obstacle));
        assert!(other.is_none(), "{other:?}");
    }

    fn all_refused(&self, is_expected: impl Fn(&Obstacle) -> bool) {
        assert_eq!(self.accepted, 0);
        self.only_refused(is_expected);
    }
}

fn moved(obstacle: &Obstacle) -> bool {
    matches!(obstacle, Obstacle::Moved { .. })
}

/// The finger falls when its tendons are slackened.
fn restless(obstacle: &Obstacle) -> bool {
    matches!(obstacle, Obstacle::UnsteadyGauge { .. })
}

#[test]
fn a_spring_that_stands_still_is_zeroed() {
    for scheme in SCHEMES {
        let tally = Tally::of(&format!("{scheme:?}"), 100, |seed| {
            let trial = Trial { gravity: Vector3::zeros(), ..Trial::new(scheme, seed) };
            trial.zero(&mut trial.spring(), |_, _| {})
        });
        assert_eq!(tally.refused, []);
        let tally = Tally::of(&format!("{scheme:?}, gravity"), 50, |seed| {
            let trial = Trial::new(scheme, seed);
            trial.zero(&mut trial.spring(), |_, _| {})
        });
        tally.only_refused(restless);
        assert!(tally.accepted > 25);
    }
}

#[test]
fn a_spring_that_is_pushed_while_it_is_read_is_refused() {
    for scheme in SCHEMES {
        let tally = Tally::of(&format!("{scheme:?}, pushed"), 50, |seed| {
            let mut trial = Trial::new(scheme, seed);
            let at = trial.chance.between(0.02, 0.25);
            let force = trial.chance.direction() * trial.chance.between(0.5, 3.0);
            trial.zero(&mut trial.spring(), |seconds, plant| {
                plant.set_external_force(if seconds > at { force } else { Vector3::zeros() })
            })
        });
        tally.all_refused(moved);
    }
}

#[test]
fn a_spring_that_is_released_while_it_is_read_is_refused() {
    for scheme in SCHEMES {
        let tally = Tally::of(&format!("{scheme:?}, released"), 50, |seed| {
            let mut trial = Trial::new(scheme, seed);
            let at = trial.chance.between(0.02, 0.25);
            let mut bench = trial.spring();
            bench.plant.hold(bench.plant.joints() + trial.chance.direction() * 0.05);
            bench.go_on(0.5);
            trial.zero(&mut bench, |seconds, plant| {
                if seconds > at {
                    plant.release();
                }
            })
        });
        tally.all_refused(moved);
    }
}

#[test]
fn a_moving_spring_is_refused() {
    for scheme in SCHEMES {
        let tally = Tally::of(&format!("{scheme:?}, on its way"), 50, |seed| {
            let mut trial = Trial::new(scheme, seed);
            let mut bench = trial.spring();
            let joints = bench.report.joints + trial.chance.direction() * 0.1;
            let stiffness = nalgebra::Matrix3::identity() * 3.0;
            bench.run(0.03, &Activity::Follow(SetPoint::hard_finger(joints, stiffness)));
            trial.zero(&mut bench, |_, _| {})
        });
        tally.all_refused(moved);
    }
}

#[test]
fn a_limp_finger_that_is_held_is_zeroed() {
    let tally = Tally::of("limp, held", 50, |seed| {
        let trial = Trial::new(Scheme::StateFeedback, seed);
        trial.zero(&mut trial.limp(), |_, _| {})
    });
    assert_eq!(tally.refused, []);
}

#[test]
fn a_limp_finger_that_nothing_holds_is_refused() {
    for friction in [0.5e-3, 5e-3] {
        let tally = Tally::of(&format!("limp, not held, joint friction {friction} N m"), 50, |seed| {
            let mut trial = Trial::new(Scheme::StateFeedback, seed);
            trial.truth.simulation.joint_coulomb_friction = [friction; 3];
            trial.zero(&mut trial.limp(), |_, plant| plant.release())
        });
        // In the trials without NotHeld, the finger falls, or reaches its stops, before the routine can push it.
        let pushed = tally.refused.iter().filter(|(_, obstacle)| matches!(obstacle, Obstacle::NotHeld { .. }));
        assert!(tally.accepted == 0 && pushed.count() > 25, "{:?}", tally.refused);
    }
}

#[test]
fn a_limp_finger_that_is_released_during_the_reading_gets_no_wrong_zeros() {
    let tally = Tally::of("limp, released", 200, |seed| {
        let mut trial = Trial::new(Scheme::StateFeedback, seed);
        let at = trial.chance.between(0.0, 9.0);
        trial.zero(&mut trial.limp(), |seconds, plant| {
            if seconds > at {
                plant.release();
            }
        })
    });
    assert!(tally.accepted > 10 && tally.refused.len() > 100);
}
