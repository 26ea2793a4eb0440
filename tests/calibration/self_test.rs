//! The self-test names at least 98 % of the faults that are tried (wrong wiring, dead parts and wrong gauge gains), and
//! passes fingers that are wired correctly.

use crate::bench::Bench;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use sun2xp::calibration::{Findings, Obstacle, Task};
use sun2xp::model::configuration::ConfiguredFinger;

/// Number of wrong wirings that are tried with every seed.
const KINDS: usize = 20;

/// Number of fingers that are tried with every kind of wrong wiring.
const SEEDS: u64 = 20;

/// The self-test ends within this time, s.
const LONGEST: f64 = 2.0;

/// The pairs of tendons.
const PAIRS: [(usize, usize); 6] = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)];

/// Returns a finger and its configuration. They differ as much as a calibrated finger and its configuration differ.
fn fingers(seed: u64) -> (ConfiguredFinger, ConfiguredFinger) {
    let mut random = Pcg64::seed_from_u64(seed);
    let mut within = |low: f64, high: f64| low + (high - low) * (random.next_u32() as f64 / f64::from(u32::MAX));
    let mut belief = ConfiguredFinger::default();
    belief.gauge.zero = [100.0; 4];
    let mut truth = belief.clone();
    let simulation = &mut truth.simulation;
    simulation.seed = seed;
    simulation.start_degrees = [within(-40.0, 40.0), within(-10.0, 80.0), within(20.0, 100.0)];
    simulation.tendon_stiffness = std::array::from_fn(|_| 300.0 * within(0.9, 1.1));
    simulation.gauge_gain_ratio = std::array::from_fn(|_| within(0.98, 1.02));
    simulation.motor_constant_ratio = std::array::from_fn(|_| within(0.9, 1.1));
    simulation.motor_coulomb_friction = simulation.motor_coulomb_friction.map(|friction| friction * within(0.7, 1.3));
    simulation.moment_arm_ratio = std::array::from_fn(|_| std::array::from_fn(|_| within(0.98, 1.02)));
    (truth, belief)
}

/// Mixes up the wiring of a bench. Returns the name of the kind, and what the self-test must report.
fn mix_up(bench: &mut Bench, kind: usize, seed: usize) -> (&'static str, fn(&Obstacle) -> bool, [u8; 2]) {
    let (one, other) = PAIRS[(seed + kind) % PAIRS.len()];
    let part = (seed + kind) % 4;
    let pair = [one as u8 + 1, other as u8 + 1];
    let own = [part as u8 + 1; 2];
    let wiring = &mut bench.wiring;
    match kind {
        0 | 1 => {
            wiring.swap_motors(one, other);
            ("motors swapped", |o| matches!(o, Obstacle::SwappedMotors { .. }), pair)
        }
        2..=4 => {
            wiring.swap_tendons(one, other);
            ("tendons swapped", |o| matches!(o, Obstacle::SwappedTendons { .. }), pair)
        }
        5..=7 => {
            wiring.swap_gauges(one, other);
            ("gauges swapped", |o| matches!(o, Obstacle::SwappedGauges { .. }), pair)
        }
        8 | 9 => {
            wiring.swap_encoders(one, other);
            ("encoders swapped", |o| matches!(o, Obstacle::SwappedEncoders { .. }), pair)
        }
        10 | 11 => {
            wiring.reverse_motor(part);
            ("motor backwards", |o| matches!(o, Obstacle::ReversedMotor { .. }), own)
        }
        12 | 13 => {
            wiring.reverse_encoder(part);
            ("encoder backwards", |o| matches!(o, Obstacle::ReversedEncoder { .. }), own)
        }
        14 => {
            wiring.reverse_gauge(part);
            ("gauge reversed", |o| matches!(o, Obstacle::ReversedGauge { .. }), own)
        }
        15 => {
            bench.sensors.rescale_gauge(part, 0.8);
            ("gauge 20 % low", |o| matches!(o, Obstacle::GaugeScale { percent, .. } if *percent < -10.0), own)
        }
        16 => {
            bench.sensors.rescale_gauge(part, 1.2);
            ("gauge 20 % high", |o| matches!(o, Obstacle::GaugeScale { percent, .. } if *percent > 10.0), own)
        }
        17 => {
            bench.sensors.kill_gauge(part, Some(300));
            ("dead gauge", |o| matches!(o, Obstacle::SilentGauge { .. }), own)
        }
        18 => {
            wiring.stop_encoder(part, 77);
            ("dead encoder", |o| matches!(o, Obstacle::DeadEncoder { .. }), own)
        }
        _ => {
            wiring.disconnect_motor(part);
            ("dead motor", |o| matches!(o, Obstacle::DeadMotor { .. }), own)
        }
    }
}

/// The numbers of the parts that a refusal names.
fn parts(obstacle: &Obstacle) -> [u8; 2] {
    match *obstacle {
        Obstacle::SwappedMotors { first, second }
        | Obstacle::SwappedEncoders { first, second }
        | Obstacle::SwappedTendons { first, second }
        | Obstacle::SwappedGauges { first, second } => [first.min(second), first.max(second)],
        Obstacle::ReversedMotor { motor: part } | Obstacle::DeadMotor { motor: part } => [part; 2],
        Obstacle::ReversedEncoder { encoder: part } | Obstacle::DeadEncoder { encoder: part } => [part; 2],
        Obstacle::ReversedGauge { gauge: part }
        | Obstacle::SilentGauge { gauge: part, .. }
        | Obstacle::GaugeScale { gauge: part, .. } => [part; 2],
        _ => [0; 2],
    }
}

#[test]
fn every_kind_of_wrong_wiring_is_named() {
    let (mut named, mut longest, mut largest) = (0, 0.0f64, 0.0f64);
    let mut table = std::collections::BTreeMap::<&str, (u32, u32)>::new();
    let mut wrong = String::new();
    for kind in 0..KINDS {
        for seed in 0..SEEDS {
            let (truth, belief) = fingers(100 * kind as u64 + seed);
            let mut bench = Bench::new(&truth, &belief, [1000.0, 500.0, 2000.0][seed as usize % 3]);
            let (name, is_named, expected) = mix_up(&mut bench, kind, seed as usize);
            let found = bench.calibrate(Task::SelfTest);
            let right = matches!(&found, Err(obstacle) if is_named(obstacle) && parts(obstacle) == expected);
            let row = table.entry(name).or_default();
            (row.0, row.1) = (row.0 + u32::from(right), row.1 + 1);
            named += u32::from(right);
            if !right {
                wrong += &format!("{name} {expected:?}, seed {seed}: {found:?}\n");
            }
            longest = longest.max(bench.seconds);
            largest = largest.max(bench.largest_tension);
            assert!(bench.largest_tension < truth.tendon.maximum, "{name}, seed {seed}: {}", bench.largest_tension);
        }
    }
    println!("{table:?}, longest {longest:.2} s, largest tension {largest:.1} N");
    assert!(longest < LONGEST, "{longest} s");
    assert!(f64::from(named) >= 0.98 * (KINDS as f64) * SEEDS as f64, "{named} named:\n{wrong}");
}

#[test]
fn a_finger_that_is_wired_correctly_passes() {
    let mut wrong = String::new();
    for seed in 0..3 * SEEDS {
        let (truth, belief) = fingers(5000 + seed);
        let mut bench = Bench::new(&truth, &belief, [1000.0, 500.0, 2000.0][seed as usize % 3]);
        let found = bench.calibrate(Task::SelfTest);
        if found != Ok(Findings::RightWiring) {
            wrong += &format!("seed {seed}: {found:?}\n");
        }
        assert!(bench.seconds < LONGEST, "{}", bench.seconds);
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// All tendons are tightened from their pretension to three times their pretension. A gauge whose gain is only 0.08 of
/// its original gain shows 0.08 of this rise.
#[test]
fn a_gauge_that_hardly_responds_is_reported_with_its_rise() {
    let (truth, belief) = fingers(6000);
    let pretension = belief.tendons().expect("a good finger").pretension(belief.tendon.minimum);
    for gauge in 0..4 {
        let mut bench = Bench::new(&truth, &belief, 1000.0);
        bench.sensors.rescale_gauge(gauge, 0.08);
        let found = bench.calibrate(Task::SelfTest);
        let Err(Obstacle::SilentGauge { newton, .. }) = found else { panic!("{found:?}") };
        let expected = 0.08 * 2.0 * pretension[gauge];
        assert!((newton - expected).abs() < 0.25 * expected, "gauge {gauge}: {newton} N instead of {expected} N");
    }
}
