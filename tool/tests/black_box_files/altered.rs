//! Alters the values, keys and arrays of a recording, one at a time, and several numbers at once. No altered recording
//! makes the reader or the replay panic.

use crate::recorded::{record, recorded, varied};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};
use serde_json::Value;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use sun2xp::finger::Recording;
use sun2xp::model::configuration::Scheme;

/// Replacements for a value. `NaN` is not JSON.
const INSTEAD: [&str; 18] = [
    "null",
    "NaN",
    "true",
    "\"text\"",
    "[]",
    "{}",
    "-1",
    "0",
    "0.5",
    "5e-324",
    "1e12",
    "1e29",
    "1e308",
    "-1e308",
    "1e400",
    "18446744073709551615",
    "-9223372036854775808",
    "100000000000000000000000000000000000000000",
];

/// Marks the place of a replacement.
const MARK: &str = "@instead@";

/// If [`EVERYTHING`] is not set, only one in this many alterations of a single place is tried.
const SAMPLE: usize = 41;

/// Number of tried alterations that change several numbers at once, if [`EVERYTHING`] is not set.
const AT_ONCE: usize = 400;

/// If this variable is set, every alteration is tried, with every controller. The number of alterations that change
/// several numbers at once is then 200 times as large.
const EVERYTHING: &str = "SUN2XP_EVERY_ALTERATION";

/// A recording as lines of JSON values.
struct Lines(Vec<Value>);

impl Lines {
    fn of(recording: &Recording) -> Self {
        let mut text = Vec::new();
        recording.write(&mut text).expect("written");
        let text = String::from_utf8(text).expect("text");
        Self(text.lines().map(|line| serde_json::from_str(line).expect("a line")).collect())
    }

    /// Every place, as line number and JSON pointer.
    fn places(&self) -> Vec<(usize, String)> {
        let mut places = Vec::new();
        for (line, value) in self.0.iter().enumerate() {
            collect(value, String::new(), &mut |pointer| places.push((line, pointer)));
        }
        places
    }

    fn at(&mut self, (line, pointer): &(usize, String)) -> &mut Value {
        self.0[*line].pointer_mut(pointer).expect("a place of these lines")
    }

    fn text(&self) -> String {
        let lines = self.0.iter().map(|line| serde_json::to_string(line).expect("text") + "\n");
        lines.collect::<String>()
    }
}

fn collect(value: &Value, pointer: String, found: &mut impl FnMut(String)) {
    match value {
        Value::Array(values) => {
            values.iter().enumerate().for_each(|(index, value)| collect(value, format!("{pointer}/{index}"), found));
        }
        Value::Object(values) => {
            values.iter().for_each(|(key, value)| collect(value, format!("{pointer}/{key}"), found));
        }
        _ => {}
    }
    found(pointer);
}

/// Number of altered recordings for each outcome.
#[derive(Default)]
struct Outcomes(BTreeMap<&'static str, usize>);

impl Outcomes {
    /// Reads and replays `text`, an altered recording. `what` describes the alteration.
    fn note(&mut self, text: &str, what: &dyn Fn() -> String) {
        let run = || {
            let refused = |error: String| {
                assert!(error.lines().count() == 1 && error.len() < 500, "one short line: {error}");
                assert!(!error.contains(char::is_control), "{error:?}");
            };
            match Recording::read(text.as_bytes(), "altered.jsonl") {
                Err(error) => {
                    refused(error.to_string());
                    "refused as it was read"
                }
                Ok(recording) => match recording.replay() {
                    Err(error) => {
                        refused(error.to_string());
                        "refused before or during the computation"
                    }
                    Ok(replayed) if replayed.different > 0 => "a difference was found",
                    Ok(_) => "made no difference",
                },
            }
        };
        match catch_unwind(AssertUnwindSafe(run)) {
            Ok(outcome) => *self.0.entry(outcome).or_default() += 1,
            Err(_) => panic!("the reading or the replay panicked with {}", what()),
        }
    }

    fn count(&self) -> usize {
        self.0.values().sum()
    }
}

/// Replaces every value, one at a time, by every value of [`INSTEAD`].
fn alter_values(lines: &mut Lines, every: usize, outcomes: &mut Outcomes) {
    let mut turn = 0;
    for place in lines.places() {
        let before = std::mem::replace(lines.at(&place), MARK.into());
        for instead in INSTEAD {
            turn += 1;
            if turn % every == 0 {
                let text = lines.text().replace(&format!("\"{MARK}\""), instead);
                outcomes.note(&text, &|| format!("{instead} at {place:?}"));
            }
        }
        *lines.at(&place) = before;
    }
}

/// Removes every key, and makes every array shorter, longer and much longer.
fn alter_shapes(lines: &mut Lines, every: usize, outcomes: &mut Outcomes) {
    let mut turn = 0;
    let mut note = |lines: &Lines, what: &dyn Fn() -> String| {
        turn += 1;
        if turn % every == 0 {
            outcomes.note(&lines.text(), what);
        }
    };
    for place in lines.places() {
        let before = lines.at(&place).clone();
        match &before {
            Value::Object(values) => {
                for key in values.keys() {
                    let mut fewer = values.clone();
                    fewer.remove(key);
                    *lines.at(&place) = fewer.into();
                    note(lines, &|| format!("no {key} at {place:?}"));
                }
            }
            Value::Array(values) => {
                let more = values.first().cloned().unwrap_or(Value::Null);
                let longer = |by: usize| [values.clone(), vec![more.clone(); by]].concat();
                let shorter = values[..values.len().saturating_sub(1)].to_vec();
                for altered in [shorter, Vec::new(), longer(1), longer(1000)] {
                    *lines.at(&place) = altered.into();
                    note(lines, &|| format!("another length at {place:?}"));
                }
            }
            _ => continue,
        }
        *lines.at(&place) = before;
    }
}

/// Alters two to six numbers at once.
fn alter_at_once(lines: &mut Lines, times: usize, outcomes: &mut Outcomes) {
    let mut random = Pcg64Mcg::seed_from_u64(1990);
    let places = lines.places();
    let numbers: Vec<_> = places.into_iter().filter(|place| lines.at(place).is_number()).collect();
    for _ in 0..times {
        let mut below = |bound: usize| random.next_u64() as usize % bound;
        // The chosen entries of `INSTEAD` are numbers, most of which pass the parser.
        let chosen: Vec<_> =
            (0..2 + below(5)).map(|_| (&numbers[below(numbers.len())], INSTEAD[6 + below(8)])).collect();
        let before: Vec<_> = chosen
            .iter()
            .map(|(place, instead)| {
                std::mem::replace(lines.at(place), serde_json::from_str(instead).expect("a number"))
            })
            .collect();
        outcomes.note(&lines.text(), &|| format!("{chosen:?}"));
        for ((place, _), before) in chosen.iter().zip(before).rev() {
            *lines.at(place) = before;
        }
    }
}

/// Peak memory of this process, MiB.
fn most_memory() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").expect("Linux");
    let line = status.lines().find(|line| line.starts_with("VmHWM:")).expect("a line");
    line.split_whitespace().nth(1).and_then(|number| number.parse::<u64>().ok()).expect("kB") / 1024
}

#[test]
fn altered_recordings_are_refused_or_replayed() {
    let everything = std::env::var_os(EVERYTHING).is_some();
    let (every, times) = if everything { (1, 200 * AT_ONCE) } else { (SAMPLE, AT_ONCE) };
    let mut recordings = vec![varied(&recorded().opening), varied(&recorded().running)];
    if everything {
        for scheme in [Scheme::Figure9, Scheme::Figure10, Scheme::Figure11] {
            let recorded = record(scheme);
            recordings.extend([varied(&recorded.opening), varied(&recorded.running)]);
        }
    }
    let mut outcomes = Outcomes::default();
    for recording in &recordings {
        let mut lines = Lines::of(recording);
        alter_values(&mut lines, every, &mut outcomes);
        alter_shapes(&mut lines, every, &mut outcomes);
        alter_at_once(&mut lines, times / recordings.len(), &mut outcomes);
    }
    println!("{} altered recordings: {:?}, {} MiB", outcomes.count(), outcomes.0, most_memory());
    assert!(outcomes.0.len() == 4 && outcomes.0.values().all(|&count| count > 20), "{:?}", outcomes.0);
    assert!(most_memory() < 400, "{} MiB", most_memory());
}
