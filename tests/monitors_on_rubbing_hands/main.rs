//! Friction along the tendons, tendons that become stiffer under tension, and inexact parameters are not faults of a
//! hand, so the monitors must report no fault. Real faults of such a hand must still be reported in time.

#[allow(dead_code)]
#[path = "../calibration/bench.rs"]
mod bench;
#[allow(dead_code)]
#[path = "../common/finger_on_a_cable.rs"]
mod finger_on_a_cable;
#[allow(dead_code)]
#[path = "../fault_injection/rig.rs"]
mod rig;
mod truths;

use nalgebra::Vector3;
use rig::{Bench, MILLISECOND};
use std::collections::BTreeMap;
use std::panic::catch_unwind;
use sun2xp::calibration::Task;
use sun2xp::control::Numbers;
use sun2xp::finger::{Fault, FaultKind};
use sun2xp::model::configuration::{Configuration, ConfiguredFinger};
use sun2xp::simulated::Defect;
use truths::{RUBBING, Truth, truths};

/// Opens a finger whose true properties are those of `truth`. Odd seeds have the stiffness of 6 N/cm instead of 3 N/cm.
fn bench(truth: &Truth, seed: u64) -> Bench {
    let mut configuration = Configuration::default();
    let finger = &mut configuration.fingers[0];
    (truth.make)(finger);
    finger.simulation.seed = seed;
    if seed % 2 == 1 {
        finger.stiffness.initial = [[6.0, 0.0, 0.0], [0.0, 6.0, 0.0], [0.0, 0.0, 6.0]];
    }
    Bench::new(configuration, seed)
}

/// Runs without a new target.
fn rest(bench: &mut Bench, milliseconds: u64) {
    bench.next_target = bench.next_target.max(bench.now() + milliseconds * MILLISECOND);
    bench.run(milliseconds);
}

/// Pushes the resting fingertip with this force, N, in a random direction.
fn push(bench: &mut Bench, newton: f64, milliseconds: u64) {
    let mut part = || bench.random(-1.0, 1.0);
    let direction = Vector3::new(part(), part(), part());
    let force = direction.normalize() * newton;
    bench.with_finger(|finger| finger.plant().set_external_force(force));
    rest(bench, milliseconds);
    bench.with_finger(|finger| finger.plant().set_external_force(Vector3::zeros()));
}

/// Bumps the fingertip for 20 ms in several poses.
fn bumps(bench: &mut Bench, newton: f64) {
    for _ in 0..4 {
        push(bench, newton, 20);
        rest(bench, 250);
        bench.run(400);
    }
}

fn pushes(bench: &mut Bench) {
    for _ in 0..6 {
        push(bench, 0.8, 150);
        rest(bench, 100);
    }
}

/// Lets the finger move and rest, pushes it, and bumps it. Returns the first fault, and the act that caused the fault.
fn life(bench: &mut Bench) -> Option<(Fault, &'static str)> {
    type Act = fn(&mut Bench);
    let acts: [(&'static str, Act); 6] = [
        ("moves", |bench| bench.run(3000)),
        ("rests", |bench| rest(bench, 1500)),
        ("pushed", pushes),
        ("bump of 4 N", |bench| bumps(bench, 4.0)),
        ("bump of 8 N", |bench| bumps(bench, 8.0)),
        ("moves again", |bench| bench.run(2000)),
    ];
    acts.iter().find_map(|(what, act)| {
        act(bench);
        bench.fault().map(|fault| (fault, *what))
    })
}

#[test]
fn a_hand_that_only_rubs_or_was_measured_badly_has_no_fault() {
    for truth in truths() {
        for seed in 0..2 {
            let alarm = life(&mut bench(&truth, seed));
            assert!(alarm.is_none(), "{}, {seed}: {alarm:?}", truth.what);
        }
    }
}

/// Identifies a finger whose true properties are those of `truth`. Returns the simulated finger, and the configuration
/// with the findings.
fn identified(truth: &Truth, seed: u64) -> (Configuration, Configuration) {
    let (mut simulated, mut configuration) = (Configuration::default(), Configuration::default());
    let finger = &mut simulated.fingers[0];
    (truth.make)(finger);
    // Zeroing comes before identification, and removes the offsets.
    finger.simulation.gauge_offset = [0.0; 4];
    finger.simulation.seed = seed;
    let mut bench = bench::Bench::new(finger, &ConfiguredFinger::default(), 1000.0).open();
    bench.calibrate(Task::Identify).unwrap_or_else(|obstacle| panic!("{}: {obstacle}", truth.what));
    configuration.fingers[0] = bench.belief;
    println!("{}: {:?}", truth.what, configuration.fingers[0].monitors);
    (simulated, configuration)
}

#[test]
fn an_identified_hand_has_no_fault() {
    const SKIPPED: [&str; 5] = ["conduit 10 %", "k x1.3", "moment arms +-5 %, other signs", "gauges +5 %", "worn"];
    for truth in truths().into_iter().filter(|truth| !SKIPPED.contains(&truth.what)) {
        let (simulated, mut configuration) = identified(&truth, 5);
        configuration.fingers[0].stiffness.initial = [[6.0, 0.0, 0.0], [0.0, 6.0, 0.0], [0.0, 0.0, 6.0]];
        let alarm = life(&mut Bench::simulating(&simulated, configuration, 5));
        assert!(alarm.is_none(), "{}: {alarm:?}", truth.what);
    }
}

/// Poses, degrees, in which a push of 1.2 N along x makes two tendons slack for a moment. The other two tendons
/// meanwhile slide in their conduits, and slide back when the first two are taut again.
const SLACKENED: [[f64; 3]; 4] = [[-9.4, 6.6, 41.8], [-9.9, 1.8, 53.1], [-15.5, -4.0, 60.0], [-12.0, 3.0, 50.0]];

/// The stiffness tolerance is small, as after an identification. So only the tolerance for friction can explain the
/// difference between gauges and encoders.
#[test]
fn a_tendon_that_hangs_for_a_moment_on_an_identified_hand_is_no_fault() {
    for pose in SLACKENED {
        for seed in 0..4 {
            let mut configuration = Configuration::default();
            let finger = &mut configuration.fingers[0];
            (RUBBING.make)(finger);
            finger.friction.conduit = [0.232; 4];
            finger.tendon.stiffness_tolerance = 0.047;
            finger.simulation.start_degrees = pose;
            finger.simulation.seed = seed;
            finger.stiffness.initial = [[6.0, 0.0, 0.0], [0.0, 6.0, 0.0], [0.0, 0.0, 6.0]];
            let mut bench = Bench::new(configuration, seed);
            rest(&mut bench, 300);
            for newton in [-1.2, 1.2] {
                bench.with_finger(|finger| finger.plant().set_external_force(Vector3::x() * newton));
                rest(&mut bench, 500);
                assert_eq!(bench.fault(), None, "{pose:?}, seed {seed}, {newton} N");
                bench.with_finger(|finger| finger.plant().set_external_force(Vector3::zeros()));
                rest(&mut bench, 500);
            }
        }
    }
}

/// Returns the period of the dither of finger 1, ns, rounded up to whole milliseconds.
fn dither_period(configuration: &Configuration) -> u64 {
    let numbers = Numbers::new(&configuration.fingers[0].controller, configuration.hand.rate).expect("usable numbers");
    (1000.0 / numbers.dither_frequency).ceil() as u64 * MILLISECOND
}

/// Checks after a cycle whether the true state of the finger shows the defect of a part: returns the sign of the
/// deviation, or 0 if the defect does not show.
type Shows = fn(&Bench, u8) -> f64;

/// Injects a defect into a part of the rubbing hand, which continues to move. Returns the part, the fault, and the time
/// to the fault, ms. Without `shows`, the time counts from the injection. Otherwise it counts from the end of the first
/// cycle after which the defect shows. The count starts again whenever the defect changes its direction. It also starts
/// again if the defect was absent for more than one period of the dither and then shows again.
fn report(seed: u64, defect: impl Fn(u8) -> Defect, shows: Option<Shows>) -> (u8, Option<Fault>, f64) {
    let mut bench = bench(&RUBBING, seed);
    let dither_period = dither_period(&bench.configuration);
    let before = 3000 + bench.random(0.0, 1000.0) as u64;
    bench.run(before);
    let part = bench.part();
    bench.mark();
    assert!(bench.with_finger(|finger| finger.inject(&defect(part))));
    let injected = bench.now();
    let (mut began, mut last, mut direction) = (shows.is_none().then_some(injected), injected, 0.0);
    while bench.fault().is_none() && bench.now() < injected + 5000 * MILLISECOND {
        bench.cycle();
        let (now, shown) = (bench.now(), shows.map_or(0.0, |shows| shows(&bench, part)));
        if shown != 0.0 {
            if began.is_none() || shown != direction || now - last > dither_period {
                began = Some(now);
            }
            (last, direction) = (now, shown);
        }
    }
    (part, bench.fault(), (bench.now() - began.unwrap_or(bench.now())) as f64 * 1e-6)
}

/// Returns the sign of the pull of a motor minus the tension of its tendon, or 0 if friction may hold the difference.
fn out_of_balance(bench: &Bench, motor: u8) -> f64 {
    let (motor, finger) = (usize::from(motor) - 1, bench.finger());
    let (pull, tension) = (bench.truth.pulls[motor], bench.truth.tensions[motor]);
    let held = finger.monitors.stall_torque[motor] / finger.geometry.motor_radius[motor];
    let tolerated = held + finger.monitors.stall_fraction * pull.abs().max(tension);
    if (pull - tension).abs() > tolerated { (pull - tension).signum() } else { 0.0 }
}

/// Injects a defect with several seeds. Returns the median and the longest time until the report, ms.
fn reports(seeds: u64, kinds: &[FaultKind], defect: impl Fn(u8) -> Defect, shows: Option<Shows>) -> (f64, f64) {
    let mut times: Vec<f64> = (0..seeds)
        .map(|seed| {
            let (part, fault, time) = report(seed, &defect, shows);
            let right = fault.is_some_and(|fault| kinds.contains(&fault.kind));
            assert!(right, "{kinds:?}, seed {seed}, part {part}: {fault:?} after {time} ms");
            time
        })
        .collect();
    times.sort_by(f64::total_cmp);
    println!("{kinds:?}: {times:.0?}");
    (times[times.len() / 2], times[times.len() - 1])
}

#[test]
fn a_cut_tendon_of_a_rubbing_hand_is_reported() {
    let (_, worst) = reports(8, &[FaultKind::BrokenTendon], Defect::CutTendon, None);
    assert!(worst <= 20.0, "{worst} ms");
}

#[test]
fn a_dead_gauge_of_a_rubbing_hand_is_reported() {
    let zero = |gauge| Defect::DeadGauge { gauge, count: Some(0) };
    let (_, worst) = reports(8, &[FaultKind::GaugeStuck], zero, None);
    assert!(worst <= 20.0, "{worst} ms");
    let last = |gauge| Defect::DeadGauge { gauge, count: None };
    let (_, worst) = reports(8, &[FaultKind::GaugeStuck], last, None);
    assert!(worst <= 40.0, "{worst} ms");
}

#[test]
fn a_jammed_motor_of_a_rubbing_hand_is_reported() {
    let (median, worst) = reports(8, &[FaultKind::StalledMotor], Defect::JammedMotor, Some(out_of_balance));
    // The time is 0 if the motor is never out of balance. Then nothing would be measured.
    assert!(median > 0.0 && worst <= 200.0, "{median}, {worst} ms");
}

#[test]
fn a_drifting_gauge_of_a_rubbing_hand_is_reported() {
    // Before the drift is certain, the gauge may reach zero, or its motor may be far out of balance.
    let kinds = [FaultKind::GaugeDisagrees, FaultKind::BrokenTendon, FaultKind::SlackTendon, FaultKind::StalledMotor];
    for speed in [20.0, -20.0] {
        let drift = |gauge| Defect::DriftingGauge { gauge, speed };
        let (median, worst) = reports(8, &kinds, drift, None);
        assert!(median <= 3000.0 && worst <= 4000.0, "{median}, {worst} ms");
    }
}

/// Prints how many fingers of each hand have a false alarm. docs/faults.md says that no finger has a false alarm. Run
/// this test with `cargo test --test monitors_on_rubbing_hands -- --ignored --nocapture`.
#[test]
#[ignore = "takes minutes"]
fn table_of_false_alarms() {
    let mut all = Vec::new();
    for truth in truths() {
        let mut alarms: BTreeMap<String, u32> = BTreeMap::new();
        for seed in 0..12 {
            let alarm = match catch_unwind(|| life(&mut bench(&truth, seed))) {
                Ok(None) => continue,
                Ok(Some((fault, what))) => format!("{:?}, {what}", fault.kind),
                Err(_) => "does not open".into(),
            };
            *alarms.entry(alarm).or_default() += 1;
        }
        println!("| {} | {alarms:?} |", truth.what);
        all.extend(alarms.into_keys().map(|alarm| format!("{}: {alarm}", truth.what)));
    }
    assert!(all.is_empty(), "{all:#?}");
}
