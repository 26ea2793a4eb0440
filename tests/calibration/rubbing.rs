//! Identification of fingers with friction, stiction or hardening tendons, and of fingers whose configured stiffness,
//! gauge gains or moment arms are wrong.

use crate::bench::Bench;
use sun2xp::calibration::{Findings, Identified, Obstacle, Task};
use sun2xp::model::configuration::{ConfiguredFinger, NamedHand};

const SEEDS: u64 = 3;

/// A number between -1 and 1 that depends on `seed` and `index`.
fn random(seed: u64, index: u64) -> f64 {
    let mut x = (seed * 1000 + index + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (x >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// One identification: the true finger, the results, and the controller's configuration with the results.
struct Run {
    name: String,
    truth: ConfiguredFinger,
    found: Identified,
    belief: ConfiguredFinger,
    /// Largest error of a joint angle afterwards, rad.
    joint_error: f64,
}

fn run(name: &str, seed: u64, change: impl Fn(&mut ConfiguredFinger, u64)) -> Result<Run, Obstacle> {
    let mut truth = ConfiguredFinger::default();
    truth.simulation.seed = seed;
    truth.simulation.start_degrees =
        [30.0 * random(seed, 90), 35.0 + 30.0 * random(seed, 91), 60.0 + 30.0 * random(seed, 92)];
    change(&mut truth, seed);
    let mut bench = Bench::new(&truth, &ConfiguredFinger::default(), 1000.0).open();
    let name = format!("{name}, seed {seed}");
    let result = bench.calibrate(Task::Identify);
    let belief = bench.belief.clone();
    match result {
        Ok(Findings::Identified(found)) => {
            let (largest, seconds) = (bench.largest_tension, bench.seconds);
            let bench = bench.adopt();
            let joint_error = (bench.report.joints - bench.plant.joints()).amax();
            let run = Run { name, truth, found, belief, joint_error };
            run.print(largest, seconds);
            Ok(run)
        }
        Ok(other) => panic!("{name}: {other:?}"),
        Err(obstacle) => {
            eprintln!("{name}: refused: {obstacle:?}");
            Err(obstacle)
        }
    }
}

/// Identifies a finger with every seed.
fn runs(name: &str, change: impl Fn(&mut ConfiguredFinger, u64)) -> Vec<Run> {
    let all: Vec<_> = (0..SEEDS).map(|seed| run(name, seed, &change)).collect();
    all.into_iter().map(|run| run.unwrap_or_else(|obstacle| panic!("{name}: {obstacle}"))).collect()
}

impl Run {
    fn print(&self, largest: f64, seconds: f64) {
        let friction = &self.belief.friction;
        eprintln!(
            "{}: {seconds:.0} s, largest {largest:.1} N, {:.3?}\n    k {:.1?} tolerance {:.3} residual {:.2} um\n    \
             motor {:.4?} conduit {:.4?} \
             pulley {:.4?}\n    joint {:.4?} gain {:.4?} motor ratio {:.4?}\n    joint error {:.4} rad, moment arms {}",
            self.name,
            self.found.tolerances,
            self.belief.tendon.stiffness,
            self.belief.tendon.stiffness_tolerance,
            self.found.travel_residual * 1e4,
            friction.motor_coulomb,
            friction.conduit,
            friction.pulley,
            friction.joint_coulomb,
            self.found.gauge_gain.as_slice(),
            self.found.motor_ratio.as_slice(),
            self.joint_error,
            self.found.moment_arms.map_or("as configured".into(), |arms| format!("{:.4}", arms.r)),
        );
    }

    /// Checks that the tolerances of the monitors cover the friction and the remaining errors of gauge gains and moment
    /// arms, and that the configuration has these tolerances.
    fn check_tolerances(&self) {
        let (tolerances, monitors) = (self.found.tolerances, &self.belief.monitors);
        let arms = tolerances.moment_arms.expect("every joint has its stops");
        assert_eq!(monitors.friction_tolerance, tolerances.friction);
        assert_eq!((monitors.gauge_tolerance, monitors.moment_arm_tolerance), (tolerances.gauges, arms));
        let simulation = &self.truth.simulation;
        let friction = simulation.conduit_friction + simulation.pulley_friction;
        let (name, most) = (&self.name, friction + simulation.shaft_friction + 0.12);
        assert!((friction..most).contains(&tolerances.friction), "{name}: {tolerances:?}");
        let shown: [f64; 4] =
            std::array::from_fn(|gauge| simulation.gauge_gain_ratio[gauge] * self.found.gauge_gain[gauge]);
        let mean = shown.iter().sum::<f64>() / 4.0;
        assert!(shown.iter().all(|gain| (gain / mean - 1.0).abs() <= tolerances.gauges), "{name}: {tolerances:?}");
        assert!((0.02..0.05 + 0.4 * friction).contains(&tolerances.gauges), "{name}: {tolerances:?}");
        for joint in 0..3 {
            let found = self.belief.geometry.r[joint];
            let largest = found.map(f64::abs).into_iter().fold(0.0, f64::max);
            for (tendon, found) in found.into_iter().enumerate() {
                let truth = self.truth.geometry.r[joint][tendon] * simulation.moment_arm_ratio[joint][tendon];
                assert!((found - truth).abs() <= arms * largest, "{name}: {joint} {tendon}: {found}, not {truth}");
            }
        }
        assert!((0.01..0.03).contains(&arms), "{name}: {tolerances:?}");
    }

    fn near(&self, what: &str, found: &[f64], expected: f64, within: f64) {
        for (index, value) in found.iter().enumerate() {
            assert!((value - expected).abs() <= within, "{}: {what} {index}: {value}, not {expected}", self.name);
        }
    }

    /// Checks stiffness, gauge gains, friction of pulleys and conduits, joint angles and tolerances.
    fn check(&self, stiffness: f64, within: f64, gain: f64) {
        self.near("stiffness", &self.belief.tendon.stiffness, stiffness, within * stiffness);
        self.near("gauge gain", self.found.gauge_gain.as_slice(), 1.0, gain);
        let pulley = self.truth.simulation.pulley_friction;
        self.near("pulley friction", &self.belief.friction.pulley, pulley, 0.005 + 0.1 * pulley);
        let mean = self.belief.friction.pulley.iter().sum::<f64>() / 4.0;
        self.near("mean pulley friction", &[mean], pulley, 0.003 + 0.05 * pulley);
        assert!(self.joint_error < 0.01 + 0.02 * self.truth.simulation.conduit_friction, "{}", self.name);
        self.check_tolerances();
        // The friction of conduit and shaft: half of the difference between the pulls in the two directions of motion,
        // as a part of the tension.
        let (conduit, shaft) = (1.0 + self.truth.simulation.conduit_friction, self.truth.simulation.shaft_friction);
        let expected = 0.5 * (conduit * (1.0 + shaft) - (1.0 - shaft) / conduit);
        self.near("conduit friction", &self.belief.friction.conduit, expected, 0.008 + 0.08 * expected);
    }
}

#[test]
fn pulley_friction() {
    for friction in [0.0, 0.02, 0.05, 0.1] {
        for run in runs(&format!("pulley {friction}"), |truth, _| truth.simulation.pulley_friction = friction) {
            run.check(300.0, 0.015, 0.01 + 0.2 * friction);
            assert!(run.found.moment_arms.is_none(), "{}: {:?}", run.name, run.found.moment_arms);
            run.near("joint friction", &run.belief.friction.joint_coulomb, 0.05, 0.015 + 0.5 * friction);
            assert!(
                run.belief.tendon.stiffness_tolerance <= 0.04 + 0.4 * friction,
                "{}",
                run.belief.tendon.stiffness_tolerance
            );
        }
    }
}

#[test]
fn conduit_friction() {
    for friction in [0.05, 0.1, 0.2] {
        for run in runs(&format!("conduit {friction}"), |truth, _| truth.simulation.conduit_friction = friction) {
            run.check(300.0, 0.02, 0.02);
            assert!(
                run.belief.tendon.stiffness_tolerance <= 0.04 + 0.2 * friction,
                "{}",
                run.belief.tendon.stiffness_tolerance
            );
        }
    }
}

#[test]
fn friction_on_both_sides_of_the_gauge() {
    for run in runs("conduit 0.1, pulley 0.02", |truth, _| {
        (truth.simulation.conduit_friction, truth.simulation.pulley_friction) = (0.1, 0.02);
    }) {
        run.check(300.0, 0.02, 0.02);
    }
    for run in runs("conduit 0.2, pulley 0.1", |truth, _| {
        (truth.simulation.conduit_friction, truth.simulation.pulley_friction) = (0.2, 0.1);
    }) {
        run.check(300.0, 0.04, 0.05);
    }
}

#[test]
fn motor_friction() {
    for (name, factor, stiction) in [("x0", 0.0, 1.0), ("x0.3", 0.3, 1.0), ("x3", 3.0, 1.0), ("stiction x2", 1.0, 2.0)]
    {
        let change = |truth: &mut ConfiguredFinger, _| {
            truth.simulation.motor_coulomb_friction = [0.7e-3 * factor; 4];
            truth.simulation.stiction_ratio = stiction;
        };
        for run in runs(&format!("motor friction {name}"), change) {
            run.check(300.0, 0.015, 0.01);
            let expected = 0.07 * factor;
            // Static friction does not vanish at the speeds of identification.
            let within = 0.008 + 0.1 * expected + 0.02 * (stiction - 1.0);
            run.near("motor friction", &run.belief.friction.motor_coulomb, expected, within);
        }
    }
}

#[test]
fn hardening() {
    for hardening in [0.2, 0.5] {
        for run in runs(&format!("hardening {hardening}"), |truth, _| truth.simulation.hardening = hardening) {
            // The stretch, cm, and the local stiffness, N/cm, at a tension, N.
            let slope = 2.0 * hardening / 60.0;
            let stretch = |t: f64| (t * slope / (1.0 - hardening)).ln_1p() / (slope * 300.0);
            let local = |t: f64| 300.0 * (1.0 - hardening + slope * t);
            let secant = 20.0 / (stretch(25.0) - stretch(5.0));
            run.check(secant, 0.03, 0.01);
            let tolerance = run.belief.tendon.stiffness_tolerance;
            for newton in [5.0, 15.0, 30.0] {
                let off = (secant / local(newton) - 1.0).abs();
                assert!(off < tolerance + 0.01, "{}: {off} at {newton} N, tolerance {tolerance}", run.name);
            }
            assert!(tolerance < 0.1 + hardening, "{tolerance}");
        }
    }
}

#[test]
fn stiffness_and_gauges() {
    for run in runs("k x0.7", |truth, _| truth.simulation.tendon_stiffness = [210.0; 4]) {
        run.check(210.0, 0.015, 0.01);
    }
    for run in runs("gauges +-5 %", |truth, seed| {
        truth.simulation.gauge_gain_ratio = std::array::from_fn(|gauge| 1.0 + 0.05 * random(seed, gauge as u64));
    }) {
        let ratios = run.truth.simulation.gauge_gain_ratio;
        let mean = ratios.map(f64::recip).iter().sum::<f64>() / 4.0;
        for (gauge, ratio) in ratios.into_iter().enumerate() {
            let expected = 1.0 / ratio / mean;
            assert!((run.found.gauge_gain[gauge] / expected - 1.0).abs() < 0.01, "{}: gauge {gauge}", run.name);
        }
    }
}

#[test]
fn moment_arms() {
    for run in runs("moment arms +-5 %", |truth, seed| {
        truth.simulation.moment_arm_ratio = std::array::from_fn(|joint| {
            std::array::from_fn(|tendon| 1.0 + 0.05 * random(seed, 4 * joint as u64 + tendon as u64))
        });
    }) {
        for joint in 0..3 {
            for tendon in 0..4 {
                let truth = run.truth.geometry.r[joint][tendon] * run.truth.simulation.moment_arm_ratio[joint][tendon];
                let found = run.belief.geometry.r[joint][tendon];
                assert!((found - truth).abs() < 0.01, "{}: {joint} {tendon}: {found}, not {truth}", run.name);
            }
        }
        run.check(300.0, 0.03, 0.02);
    }
}

#[test]
fn everything_slightly_off() {
    for run in runs("everything", |truth, seed| {
        let off = |index: u64, part: f64| 1.0 + part * random(seed, index);
        let simulation = &mut truth.simulation;
        (simulation.conduit_friction, simulation.pulley_friction) = (0.1, 0.02);
        (simulation.stiction_ratio, simulation.hardening) = (1.3, 0.1);
        simulation.tendon_stiffness = std::array::from_fn(|tendon| 300.0 * off(tendon as u64, 0.1));
        simulation.gauge_gain_ratio = std::array::from_fn(|tendon| off(tendon as u64 + 4, 0.02));
        simulation.motor_constant_ratio = std::array::from_fn(|tendon| off(tendon as u64 + 8, 0.1));
        simulation.moment_arm_ratio =
            std::array::from_fn(|joint| std::array::from_fn(|tendon| off(12 + 4 * joint as u64 + tendon as u64, 0.02)));
    }) {
        run.near("pulley friction", &run.belief.friction.pulley, 0.02, 0.008);
        for tendon in 0..4 {
            // The gauges' common error stays, and hardening changes the secant by a few per cent.
            let ratio = run.belief.tendon.stiffness[tendon] / run.truth.simulation.tendon_stiffness[tendon];
            assert!((ratio - 0.98).abs() < 0.05, "{}: tendon {tendon}: {ratio}", run.name);
        }
    }
}

#[test]
fn named_hands() {
    for hand in NamedHand::ALL {
        for run in runs(hand.name(), |truth, seed| {
            truth.simulation = hand.simulation();
            // Zeroing comes before identification, and removes the offsets.
            truth.simulation.gauge_offset = [0.0; 4];
            truth.simulation.seed = seed;
        }) {
            let pulley = run.truth.simulation.pulley_friction;
            run.near("pulley friction", &run.belief.friction.pulley, pulley, 0.005 + 0.1 * pulley);
            assert!(run.joint_error < 0.02, "{}: {}", run.name, run.joint_error);
        }
    }
}
