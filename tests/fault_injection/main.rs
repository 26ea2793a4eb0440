//! Faults injected into a finger in motion, at random moments: each is named as it should be, the motors come to the end state in
//! time, and the finger can be opened again. `docs/faults.md` has the figures of the long run.

mod rig;

use nalgebra::Vector3;
use rig::Bench;
use sun2xp::board::{Defect, LineFault, Transport};
use sun2xp::finger::FaultKind;
use sun2xp::model::configuration::{Configuration, Scheme};

const MILLISECOND: u64 = 1_000_000;

/// Something that goes wrong.
struct Case {
    what: &'static str,
    /// Makes it happen; which part it happens to, where the fault names it.
    inject: fn(&mut Bench) -> Option<u8>,
    /// What it is to be called; the first is the best name, another one is what it also is.
    named: &'static [FaultKind],
    /// ms within which the fault must be found and the motors be off.
    within: f64,
}

fn suffer(bench: &mut Bench, defect: Defect) {
    assert!(bench.with_finger(|finger| finger.suffer(&defect)));
}

/// All frames from the board, for a second.
fn line(bench: &mut Bench, fault: LineFault) {
    let until = bench.now() + 1000 * MILLISECOND;
    let seed = bench.random(0.0, 1e9) as u64;
    bench.with_cable(|cable| cable.inject(fault, 1.0, until, seed));
}

fn cases() -> Vec<Case> {
    use FaultKind::*;
    let case = |what, named, within, inject| Case { what, inject, named, within };
    vec![
        case("cut tendon", &[BrokenTendon], 40.0, |bench| {
            let tendon = bench.part();
            suffer(bench, Defect::CutTendon(tendon));
            Some(tendon)
        }),
        case("slack tendon (grip 1 N)", &[SlackTendon], 60.0, |bench| {
            let tendon = bench.part();
            suffer(bench, Defect::SlackTendon { tendon, grip: 1.0 });
            Some(tendon)
        }),
        case("dead gauge, as it was", &[GaugeStuck], 40.0, |bench| {
            let gauge = bench.part();
            suffer(bench, Defect::DeadGauge { gauge, count: None });
            Some(gauge)
        }),
        case("dead gauge, at nothing", &[GaugeStuck], 40.0, |bench| {
            let gauge = bench.part();
            suffer(bench, Defect::DeadGauge { gauge, count: Some(0) });
            Some(gauge)
        }),
        case("dead gauge, at full scale", &[GaugeOutOfRange], 20.0, |bench| {
            let gauge = bench.part();
            suffer(bench, Defect::DeadGauge { gauge, count: Some(4095) });
            Some(gauge)
        }),
        // The controller believes the gauge, and lets the tendon go slack: now and then that is seen first.
        case("drifting gauge (20 N/s)", &[GaugeDisagrees, SlackTendon], 2000.0, |bench| {
            let (gauge, way) = (bench.part(), bench.random(-1.0, 1.0).signum());
            suffer(bench, Defect::DriftingGauge { gauge, speed: 20.0 * way });
            None
        }),
        case("encoder jump (150 counts)", &[EncoderJump], 20.0, |bench| {
            let (encoder, way) = (bench.part(), bench.random(-1.0, 1.0).signum());
            suffer(bench, Defect::EncoderJump { encoder, counts: 150 * way as i32 });
            Some(encoder)
        }),
        case("jammed motor", &[StalledMotor], 3000.0, |bench| {
            let motor = bench.part();
            suffer(bench, Defect::JammedMotor(motor));
            Some(motor)
        }),
        case("hot motor", &[DriverFault], 20.0, |bench| {
            suffer(bench, Defect::HotMotor(1));
            None
        }),
        case("a blow (40 N)", &[OverTension], 60.0, |bench| {
            bench.with_finger(|finger| finger.plant().set_external_force(Vector3::new(0.0, 40.0, 0.0)));
            None
        }),
        case("zero lost", &[ZeroLost], 20.0, |bench| {
            suffer(bench, Defect::ZeroLost);
            None
        }),
        case("emergency stop, input", &[EmergencyStopInput], 20.0, |bench| {
            suffer(bench, Defect::EmergencyStop);
            None
        }),
        case("motor supply", &[SupplyFault], 20.0, |bench| {
            suffer(bench, Defect::Supply);
            None
        }),
        case("sensor, by the board", &[SensorFault], 20.0, |bench| {
            suffer(bench, Defect::Sensor);
            None
        }),
        case("reset", &[BoardReset], 20.0, |bench| {
            suffer(bench, Defect::Reset);
            None
        }),
        case("drop", &[LostReplies], 25.0, |bench| {
            line(bench, LineFault::Drop);
            None
        }),
        case("corrupt", &[DamagedReplies], 25.0, |bench| {
            line(bench, LineFault::Corrupt);
            None
        }),
        case("delay (3 ms)", &[LostReplies], 25.0, |bench| {
            line(bench, LineFault::Delay(3 * MILLISECOND));
            None
        }),
        case("stall (100 ms)", &[LostReplies], 25.0, |bench| {
            line(bench, LineFault::Stall);
            None
        }),
        case("unplug", &[PortVanished], 25.0, |bench| {
            bench.with_cable(|cable| cable.set_plugged(false));
            None
        }),
        case("silent host (30 ms)", &[Watchdog], 45.0, |bench| {
            bench.with_cable(|cable| {
                let later = cable.now() + 30 * MILLISECOND;
                cable.advance_to(later);
            });
            None
        }),
    ]
}

/// What came of one injection: found after, and motors off after, ms.
struct Outcome {
    found: f64,
    ended: f64,
}

fn trial(case: &Case, seed: u64) -> Result<Outcome, String> {
    let mut bench = Bench::new(Configuration::default(), seed);
    let before = 300 + bench.random(0.0, 1500.0) as u64;
    bench.run(before);
    if let Some(fault) = bench.fault() {
        return Err(format!("a false alarm: {fault}"));
    }
    let began = bench.now();
    let part = (case.inject)(&mut bench);
    let since = |bench: &Bench| (bench.now() - began) as f64 * 1e-6;
    let (mut found, mut ended) = (None, None);
    while (found.is_none() || ended.is_none()) && since(&bench) < 5000.0 {
        bench.cycle();
        found = found.or(bench.fault().map(|_| since(&bench)));
        ended = ended.or(bench.ended().then(|| since(&bench)));
    }
    let fault = bench.fault().ok_or("nothing found within 5 s")?;
    let (found, ended) = (found.unwrap_or(f64::INFINITY), ended.unwrap_or(f64::INFINITY));
    if !case.named.contains(&fault.kind) || part.is_some_and(|part| part != fault.part) {
        return Err(format!("part {part:?} is called {fault} after {found} ms"));
    }
    bench.recover().run(100);
    Ok(Outcome { found, ended })
}

/// Every case so many times; a row of the table each. So many of each case may go by another name.
fn inject_all(times: u64, misnamed: usize) {
    let (mut wrong, mut too_many) = (Vec::new(), false);
    println!(
        "| injected | called | found after, ms: median, worst | end state after, ms: median, worst |\n|---|---|---|---|"
    );
    for (index, case) in cases().iter().enumerate() {
        let outcomes = (0..times).filter_map(|time| {
            let outcome = trial(case, 1000 * index as u64 + time);
            outcome.map_err(|error| wrong.push(format!("{}, {time}: {error}", case.what))).ok()
        });
        let outcomes: Vec<Outcome> = outcomes.collect();
        too_many |= outcomes.len() + misnamed < times as usize;
        let figures = |of: fn(&Outcome) -> f64| {
            let mut figures: Vec<f64> = outcomes.iter().map(of).collect();
            figures.sort_by(f64::total_cmp);
            let worst = figures.last().copied().unwrap_or(f64::NAN);
            (figures.get(figures.len() / 2).copied().unwrap_or(f64::NAN), worst)
        };
        let (found, ended) = (figures(|outcome| outcome.found), figures(|outcome| outcome.ended));
        let names: Vec<&str> = case.named.iter().map(|kind| kind.description().name).collect();
        println!(
            "| {} | {} ({} of {times}) | {:.1}, {:.1} | {:.1}, {:.1} |",
            case.what,
            names.join(" or "),
            outcomes.len(),
            found.0,
            found.1,
            ended.0,
            ended.1
        );
        if ended.1 > case.within {
            too_many = true;
            wrong.push(format!("{}: the motors are off after {} ms, not {}", case.what, ended.1, case.within));
        }
    }
    println!("{}", wrong.join("\n"));
    assert!(!too_many, "{}", wrong.join("\n"));
}

#[test]
fn every_fault_is_named_and_ends_in_time() {
    inject_all(3, 0);
}

#[test]
fn a_finger_in_motion_gives_no_false_alarm_on_a_line_that_loses_one_reply_in_twenty() {
    for scheme in [Scheme::Figure9, Scheme::Figure10, Scheme::StateFeedback] {
        for fault in [LineFault::Drop, LineFault::Corrupt, LineFault::Duplicate, LineFault::Delay(2 * MILLISECOND)] {
            let mut configuration = Configuration::default();
            configuration.fingers[0].controller.scheme = scheme;
            configuration.fingers[0].simulation.joint_coulomb_friction = [2e-3; 3];
            let mut bench = Bench::new(configuration, 7);
            bench.with_cable(|cable| cable.inject(fault, 0.05, u64::MAX, 7));
            bench.run(10_000);
            let report = bench.mailbox.report();
            assert_eq!(bench.fault(), None, "{scheme:?}, {fault:?}: {report:?}");
            if fault != LineFault::Duplicate {
                let share = report.losses.lost_replies as f64 / report.losses.cycles as f64;
                assert!((0.03..0.07).contains(&share), "{scheme:?}, {fault:?}: {share}");
                assert!(report.warnings.given() > 0, "nothing is told of a line like that");
            }
        }
    }
}

/// The table of `docs/faults.md`: `cargo test --test fault_injection -- --ignored --nocapture`.
#[test]
#[ignore = "takes minutes"]
fn every_fault_a_hundred_times() {
    inject_all(100, 3);
}
