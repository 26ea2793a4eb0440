//! Zero, scale, direction and noise of the gauges, by hanging known weights on the tendons.

use super::desk::Desk;
use super::line::Line;
use super::machine::Reading;
use super::order::{is_exchange, name_the_missing, repeats};
use super::outcome::Outcome;
use super::person::{Act, Answer};
use super::wrong::Wrong;
use crate::failure::Failure;

/// Averaging time, s.
const READING: f64 = 1.0;
/// A gauge is dead if it shows less than this fraction of a weight, with its configured scale.
const LIVES: f64 = 0.2;
/// Largest noise of a gauge, N rms.
const NOISE: f64 = 0.3;
/// Largest residual of the line as a part of the heaviest weight that hung on the tendon.
const RESIDUAL: f64 = 0.02;
/// A scale is reported if it differs from the configured one by more than this fraction.
const SCALE: f64 = 0.05;
/// A zero is reported if it differs from the configured one by more than this, N.
const ZERO: f64 = 5.0;

/// A mean count below this is at the lower end of the converter's range, counts.
const AT_END: f64 = 0.5;
/// A gauge is at the upper end of the converter's range if its mean count is nearer than this to the end, counts, and
/// its noise is smaller than this, counts rms.
const QUIET: f64 = 0.01;
/// The usual resolutions of converters, bits.
const BITS: std::ops::RangeInclusive<u32> = 8..=16;

/// What the gauges show with one tendon under its weights.
struct Weighed {
    /// Index of the gauge that shows the weights.
    gauge: usize,
    line: Line,
    /// The heaviest weight that hung on the tendon, N.
    heaviest: f64,
}

/// Whether a count is at an end of the converter's range, so that the true count may be beyond this end.
fn at_end(count: f64, noise: f64) -> bool {
    let full = |bits: u32| f64::from((1 << bits) - 1);
    count < AT_END || (noise < QUIET && BITS.into_iter().any(|bits| (count - full(bits)).abs() < QUIET))
}

/// Carries out the step `gauges`.
pub fn gauges(desk: &mut Desk) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    if !desk.prepare(&mut outcome, Act::Loosen)? {
        return Ok(outcome);
    }
    let empty = desk.read(READING)?;
    let (mut order, mut lines) = ([0; 4], [None, None, None, None]);
    for tendon in 1..=4 {
        let weighed = match weigh(desk, tendon, &empty)? {
            Ok(weighed) => weighed,
            Err(wrong) => {
                desk.person.show(&wrong.to_string());
                outcome.wrong(wrong);
                continue;
            }
        };
        desk.person.show(&format!(
            "gauge {}: {:.5} N per count; its readings deviate by {:.3} N rms from a straight line over the weights",
            weighed.gauge + 1,
            weighed.line.slope,
            weighed.line.residual
        ));
        let gauge = weighed.gauge;
        order[tendon - 1] = gauge + 1;
        lines[gauge] = Some(weighed);
    }
    let seen = order;
    name_the_missing(&mut outcome, &mut order, Wrong::GaugeDead);
    for weighed in lines.iter().flatten() {
        let Weighed { gauge, line, .. } = weighed;
        judge(desk, &mut outcome, weighed, &empty);
        outcome.found(format!(
            "gauge {}: {:.5} N per count, zero at {:.1} counts, residual {:.3} N, noise {:.3} N rms",
            gauge + 1,
            line.slope,
            line.zero,
            line.residual,
            empty.noise[*gauge] * line.slope.abs()
        ));
    }
    name_the_order(&mut outcome, seen, order);
    let weights = desk.weights.iter().map(|newton| format!("{newton:.2}")).collect::<Vec<_>>().join(", ");
    outcome.about("gauge.newton_per_count", format!("slope of the line through weights of {weights} N"));
    outcome.about("gauge.zero", format!("count without load, from the line through weights of {weights} N"));
    Ok(outcome)
}

/// Reports exchanged gauges, if an exchange explains what was `seen`. Unlike `seen`, `order` contains the gauge that
/// [`name_the_missing`] has found.
fn name_the_order(outcome: &mut Outcome, seen: [usize; 4], order: [usize; 4]) {
    let bent = outcome.wrong.iter().any(|wrong| matches!(wrong, Wrong::GaugeNotLinear(..)));
    if repeats(seen) || (is_exchange(order) && bent) {
        // A weight may have hung on a tendon other than the requested one. Then the lines are wrong too.
        outcome.wrong = vec![Wrong::GaugesUnclear(seen)];
        outcome.found.clear();
    } else if is_exchange(order) {
        outcome.wrong.retain(|wrong| !wrong.compensated());
        outcome.wrong.insert(0, Wrong::GaugesExchanged(order));
    }
}

/// Hangs every weight on one tendon. Returns what is wrong if no weight hung on it, or if no gauge shows the weight.
fn weigh(desk: &mut Desk, tendon: usize, empty: &Reading) -> Result<Result<Weighed, Wrong>, Failure> {
    let mut readings = vec![(0.0, *empty)];
    for newton in desk.weights.clone() {
        if desk.person.ask(Act::Hang(tendon, newton))? == Answer::Cannot {
            break;
        }
        readings.push((newton, desk.read(READING)?));
    }
    let (heaviest, last) = readings[readings.len() - 1];
    if heaviest == 0.0 {
        return Ok(Err(Wrong::NotWeighed(tendon)));
    }
    desk.person.ask(Act::Unhang(tendon))?;
    let scale = desk.finger.gauge.newton_per_count;
    let shown: [f64; 4] =
        std::array::from_fn(|gauge| ((last.gauges[gauge] - empty.gauges[gauge]) * scale[gauge]).abs());
    let gauge = (0..4).max_by(|&one, &other| shown[one].total_cmp(&shown[other])).unwrap_or(0);
    if shown[gauge] < LIVES * heaviest {
        return Ok(Err(Wrong::GaugeDead(tendon)));
    }
    let point = |&(newton, reading): &(f64, Reading)| (reading.gauges[gauge], newton);
    // A count at the end of the range is not on the line. Two other counts are enough for a line.
    let inside = |&&(_, reading): &&(f64, Reading)| !at_end(reading.gauges[gauge], reading.noise[gauge]);
    let points: Vec<(f64, f64)> = readings.iter().filter(inside).map(point).collect();
    let all = || Line::through(&readings.iter().map(point).collect::<Vec<_>>());
    let line = Line::through(&points).or_else(all);
    Ok(line.map(|line| Weighed { gauge, line, heaviest }).ok_or(Wrong::GaugeDead(tendon)))
}

/// Takes scale and zero of a gauge from its line. `empty` is the reading without load.
fn judge(desk: &mut Desk, outcome: &mut Outcome, weighed: &Weighed, empty: &Reading) {
    let Weighed { gauge, ref line, heaviest } = *weighed;
    let number = gauge + 1;
    let configured = &mut desk.finger.gauge;
    let noise = empty.noise[gauge] * line.slope.abs();
    if at_end(empty.gauges[gauge], empty.noise[gauge]) {
        outcome.wrong(Wrong::GaugeAtEnd(number, empty.gauges[gauge], line.zero));
    } else if noise > NOISE {
        outcome.wrong(Wrong::GaugeNoise(number, noise));
    } else if line.residual > RESIDUAL * heaviest {
        outcome.wrong(Wrong::GaugeNotLinear(number, line.residual));
    }
    if line.slope < 0.0 && configured.newton_per_count[gauge] > 0.0 {
        outcome.wrong(Wrong::GaugeReversed(number));
    }
    let ratio = (configured.newton_per_count[gauge] / line.slope).abs();
    if (ratio - 1.0).abs() > SCALE {
        outcome.wrong(Wrong::GaugeScale(number, ratio));
    }
    // The zero of a reversed gauge is at the other end of its range.
    let offset = (line.zero - configured.zero[gauge]) * line.slope;
    let known = configured.zero[gauge] != 0.0;
    if known && offset.abs() > ZERO && line.slope > 0.0 {
        outcome.wrong(Wrong::GaugeZero(number, offset));
    }
    configured.newton_per_count[gauge] = line.slope;
    configured.zero[gauge] = line.zero;
}
