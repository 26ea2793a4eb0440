//! Faults injected into a moving finger at random moments. Each must get the right name, the motors must reach the end
//! state in time, and the finger must recover. `docs/faults.md` has the figures of the ignored test
//! `every_fault_a_hundred_times`.

mod cases;
#[allow(dead_code)]
#[path = "../common/finger_on_a_cable.rs"]
mod finger_on_a_cable;
mod rig;

use cases::{Case, Injected, line, of_the_finger, of_the_line, warnings};
use rig::{Bench, MICROSECOND, MILLISECOND};
use sun2xp::finger::{Losses, Severity};
use sun2xp::model::configuration::{Configuration, Scheme};
use sun2xp::simulated::LineFault;

/// Time limit of each trial, s.
const PATIENCE: f64 = 10.0;

/// Times of one trial, ms.
#[derive(Clone, Copy)]
struct Outcome {
    /// From the injection until the fault becomes detectable.
    detectable: f64,
    /// From the moment at which the fault becomes detectable until it is named.
    found: f64,
    /// From the moment at which the fault becomes detectable until the motors are off; 0 for a warning.
    ended: f64,
}

/// Injects a fault at a random moment.
fn inject(case: &Case, rate: f64, seed: u64) -> Result<(Bench, Injected), String> {
    let mut configuration = Configuration::default();
    configuration.hand.rate = rate;
    (case.configure)(&mut configuration);
    let mut bench = Bench::new(configuration, seed);
    let before = case.after + bench.random(0.0, 1500.0) as u64;
    bench.run(before);
    if let Some(fault) = bench.fault() {
        return Err(format!("a false alarm: {fault}"));
    }
    bench.mark();
    let injected = (case.inject)(&mut bench);
    Ok((bench, injected))
}

fn trial(case: &Case, rate: f64, seed: u64, warns: bool) -> Result<Outcome, String> {
    let (mut bench, injected) = inject(case, rate, seed)?;
    let (mut known, mut since, mut found) = (case.detectable.is_none().then_some(0.0), None, None);
    bench.truth.time = 0.0;
    while (found.is_none() || known.is_none() || (!warns && bench.ended().is_none())) && bench.truth.time < PATIENCE {
        bench.cycle();
        let now = 1000.0 * bench.truth.time;
        let named = match warns {
            true => bench.warning().is_some_and(|warning| warning.kind == case.expected),
            false => bench.fault().is_some(),
        };
        if let Some(detectable) = case.detectable.filter(|_| known.is_none()) {
            let holds = (detectable.holds)(&bench.truth, &injected, bench.finger());
            since = since.filter(|_| holds).or(holds.then_some(now));
            // The fault counts as detectable from the moment at which `holds` becomes true, if `holds` stays true for
            // `lasts_ms` or until the fault is named.
            known = since.filter(|since| now - since >= detectable.lasts_ms || named);
        }
        found = found.or(named.then_some(now));
    }
    let fault = bench.fault();
    let named = match warns {
        true if fault.is_some() => false,
        true => found.is_some(),
        false => fault.is_some_and(|fault| {
            fault.kind == case.expected && injected.part.is_none_or(|part| part == fault.part.number())
        }),
    };
    if !named {
        let reported = fault.or(bench.warning()).map_or("nothing".into(), |fault| fault.to_string());
        return Err(format!("part {:?} is reported as {reported} after {found:?} ms", injected.part));
    }
    let found = found.unwrap_or(f64::INFINITY);
    let ended = if warns { 0.0 } else { bench.ended().unwrap_or(f64::INFINITY) };
    // The servo knows its own command before the motors do, so it may name a fault before the true state shows it. Then
    // the fault counts as detectable from the moment at which it is named.
    let detectable = known.unwrap_or(found).min(found);
    bench.repair();
    if !warns {
        bench.recover();
    }
    bench.run(100);
    if let Some(fault) = bench.fault() {
        return Err(format!("faults again after the repair: {fault}"));
    }
    Ok(Outcome { detectable, found: found - detectable, ended: if warns { 0.0 } else { ended - detectable } })
}

fn median_and_worst(outcomes: &[Outcome], of: fn(&Outcome) -> f64) -> String {
    let mut figures: Vec<f64> = outcomes.iter().map(of).collect();
    figures.sort_by(f64::total_cmp);
    let at = |place: usize| figures.get(place).copied().unwrap_or(f64::NAN);
    format!("{:.1}, {:.1}", at(figures.len() / 2), at(figures.len().saturating_sub(1)))
}

/// Injects every case the given number of times and prints a row of the table for each. Returns the failures.
fn inject_all(cases: &[Case], rate: f64, times: u64, warns: bool) -> Vec<String> {
    let mut wrong = Vec::new();
    // The trials below show that the finger stops with each fault and continues with each warning.
    let severity = if warns { Severity::Warning } else { Severity::Fault };
    for (index, case) in cases.iter().enumerate() {
        assert_eq!(case.expected.description().severity, severity, "{}: the table of faults", case.what);
        let mut outcomes = Vec::new();
        for time in 0..times {
            match trial(case, rate, 1000 * index as u64 + time, warns) {
                Ok(outcome) => outcomes.push(outcome),
                Err(error) => wrong.push(format!("{}, {time}: {error}", case.what)),
            }
        }
        let name = case.expected.description().name;
        let detectable = match case.detectable {
            Some(_) => median_and_worst(&outcomes, |outcome| outcome.detectable),
            None => "0".into(),
        };
        let found = median_and_worst(&outcomes, |outcome| outcome.found);
        let ended = match warns {
            true => "continues".into(),
            false => median_and_worst(&outcomes, |outcome| outcome.ended),
        };
        println!(
            "| {} | {rate} | {name} ({} of {times}) | {detectable} | {found} | {ended} |",
            case.what,
            outcomes.len()
        );
        let last = |outcome: &Outcome| if warns { outcome.found } else { outcome.ended };
        let worst = outcomes.iter().map(last).fold(0.0, f64::max);
        if worst > case.within {
            wrong.push(format!("{}: took {worst} ms, longer than {} ms", case.what, case.within));
        }
    }
    wrong
}

fn inject_everything(times: u64) {
    println!(
        "| injected | rate, Hz | reported as | detectable after, ms \
         | reported this long after that moment, ms | end state this long after that moment, ms |"
    );
    println!("|---|---|---|---|---|---|");
    let mut wrong = inject_all(&of_the_finger(), 1000.0, times, false);
    wrong.extend(inject_all(&of_the_line(), 1000.0, times, false));
    wrong.extend(inject_all(&of_the_line(), 500.0, times, false));
    wrong.extend(inject_all(&warnings(), 1000.0, times, true));
    println!("{}", wrong.join("\n"));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_fault_is_named_ends_in_time_and_recovers() {
    inject_everything(3);
}

/// Checks for a thousand cycles that the controller never uses a sample of another cycle. Returns the losses.
fn survive(fault: LineFault, probability: f64, seed: u64) -> Losses {
    let mut bench = Bench::new(Configuration::default(), seed);
    let before = 300 + bench.random(0.0, 1500.0) as u64;
    bench.run(before);
    let before = bench.report().losses;
    // The line is disturbed for 1001 ms, so that all of the thousand cycles are included.
    line(&mut bench, fault, probability, 1001);
    let mut lost = before.lost_replies;
    for _ in 0..1000 {
        bench.cycle();
        let report = bench.report();
        let answered = report.losses.lost_replies == lost;
        lost = report.losses.lost_replies;
        // The limit of 0.2 N is more than six times the noise of a gauge, which is 0.03 N rms.
        let off = (report.cycle.tensions - bench.truth.tensions).amax();
        assert!(!answered || off < 0.2, "{fault:?}, {seed}: {off} N from the truth");
    }
    bench.repair();
    bench.run(5);
    assert_eq!(bench.fault(), None, "{fault:?}, {seed}");
    bench.report().losses.since(&before)
}

fn survive_all(times: u64) {
    for (fault, probability) in [(LineFault::Duplicate, 1.0), (LineFault::Reorder, 0.5)] {
        let (mut lost, mut late, mut doubled) = (0, 0, 0);
        for seed in 0..times {
            let Losses { lost_replies, late_replies, duplicate_replies, .. } = survive(fault, probability, seed);
            match fault {
                LineFault::Duplicate => assert_eq!((lost_replies, late_replies, duplicate_replies), (0, 0, 1000)),
                // A reply that arrives after the next one is recognised by its number: it is lost for its own cycle and
                // late for the next.
                _ => assert!(lost_replies == late_replies && lost_replies > 200 && duplicate_replies == 0),
            }
            (lost, late, doubled) = (lost + lost_replies, late + late_replies, doubled + duplicate_replies);
        }
        println!(
            "{fault:?}, {times} times 1000 replies: {doubled} doubled, {late} late, {lost} lost; no fault, \
             no wrong value"
        );
    }
}

#[test]
fn doubled_and_disordered_replies_are_survived_and_counted() {
    survive_all(2);
}

#[test]
fn a_finger_in_motion_gives_no_false_alarm_on_a_line_that_loses_one_reply_in_twenty() {
    for scheme in [Scheme::Figure9, Scheme::Figure10, Scheme::StateFeedback] {
        for fault in [LineFault::Drop, LineFault::Corrupt, LineFault::Duplicate, LineFault::Delay(2_000_000)] {
            let mut configuration = Configuration::default();
            configuration.fingers[0].controller.scheme = Some(scheme);
            configuration.fingers[0].simulation.joint_coulomb_friction = [2e-3; 3];
            // The simulated stiffness equals the configured one, as after an identification. With the small tolerance
            // of an identified stiffness there must be no alarm either.
            configuration.fingers[0].tendon.stiffness_tolerance = 0.03;
            let mut bench = Bench::new(configuration, 7);
            bench.with_cable(|cable| cable.inject(fault, 0.05, u64::MAX, 7));
            bench.run(10_000);
            let report = bench.report();
            assert_eq!(bench.fault(), None, "{scheme:?}, {fault:?}: {report:?}");
            let hit = match fault {
                LineFault::Duplicate => report.losses.duplicate_replies,
                _ => report.losses.lost_replies,
            };
            let share = hit as f64 / report.losses.cycles as f64;
            assert!((0.03..0.07).contains(&share), "{scheme:?}, {fault:?}: {share}");
            if fault != LineFault::Duplicate {
                assert!(report.warnings.given() > 0, "such a line must cause a warning");
            }
        }
    }
}

/// A short pause of the servo's thread must not fault the finger. Predictions from before the pause must not be used
/// after it.
#[test]
fn a_servo_that_sometimes_pauses_for_twelve_milliseconds_keeps_its_finger() {
    for seed in 0..10 {
        let mut bench = Bench::new(Configuration::default(), seed);
        for _ in 0..60 {
            let before = bench.random(100.0, 500.0) as u64;
            bench.run(before);
            bench.pause(12 * MILLISECOND + 300 * MICROSECOND);
            (0..200).for_each(|_| bench.cycle());
            assert_eq!(bench.fault(), None, "{seed}");
        }
        let skipped = bench.report().losses.skipped_periods;
        assert!(skipped >= 60 * 10, "{seed}: the servo has not noticed the pauses: {skipped} skipped periods");
    }
}

/// Prints the table of `docs/faults.md`: `cargo test --test fault_injection -- --ignored --nocapture`.
#[test]
#[ignore = "takes minutes"]
fn every_fault_a_hundred_times() {
    survive_all(100);
    inject_everything(100);
}
