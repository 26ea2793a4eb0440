//! The table of fingers that differ from their configuration, as Markdown.

use crate::Arguments;
use crate::cases::Case;
use crate::parallel::worst;
use crate::trials::{self, Extent, Trial};
use crate::truths::{TRUTHS, Truth};
use std::error::Error;
use std::time::Instant;
use sun2xp::model::configuration::{ConfiguredFinger, Scheme};

/// Largest motion of a finger at rest, cm rms.
const AT_REST: f64 = 0.005;

pub fn run(arguments: &Arguments, only: &str, begun: Instant) -> Result<(), Box<dyn Error>> {
    let wanted = |truth: &&Truth| only.split(';').any(|text| truth.name.contains(text.trim()));
    let extent = if arguments.short { Extent::Short } else { Extent::All };
    let keys: toml_edit::DocumentMut = arguments.keys.parse()?;
    let adjust = |finger: &mut ConfiguredFinger| {
        let mut document = toml_edit::ser::to_document(finger).expect("a finger");
        overlay(document.as_table_mut(), keys.as_table());
        *finger = toml_edit::de::from_document(document).expect("usable keys");
    };
    let columns = [
        "truth",
        "error at 3 N/cm, worst / median",
        "error at 6 N/cm",
        "rest at 3 / 6 N/cm, um",
        "not at rest",
        "settling, overshoot",
        "at walls, um",
        "tensions back after a bump",
        "faults",
    ];
    println!("| {} |\n|{}", columns.join(" | "), "---|".repeat(columns.len()));
    for truth in TRUTHS.iter().filter(wanted) {
        let mut all = Vec::new();
        for seed in 0..arguments.seeds {
            let rate = arguments.rates.as_ref().map_or(1000.0, |rates| rates[0]);
            let scheme = arguments.controllers.last().copied().unwrap_or(Scheme::StateFeedback);
            let case = Case { scheme, rate, poses: arguments.poses.unwrap_or(12), seed: arguments.seed + seed * 1000 };
            all.extend(trials::trials(&case, truth, arguments.identified, extent, &adjust));
        }
        println!("{}", row(truth.name, &all));
    }
    eprintln!("{:.0} s", begun.elapsed().as_secs_f64());
    Ok(())
}

fn overlay(below: &mut toml_edit::Table, above: &toml_edit::Table) {
    for (key, item) in above {
        match (below.get_mut(key).and_then(|item| item.as_table_like_mut()), item.as_table_like()) {
            (Some(below), Some(above)) => {
                for (key, item) in above.iter() {
                    below.insert(key, item.clone());
                }
            }
            _ => {
                below.insert(key, item.clone());
            }
        }
    }
}

fn row(name: &str, all: &[Trial]) -> String {
    let refused: Vec<_> = all.iter().filter_map(|trial| trial.refused.as_ref()).collect();
    let done: Vec<&Trial> = all.iter().filter(|trial| trial.refused.is_none()).collect();
    if done.is_empty() {
        return format!("| {name} | refused: {} |", refused[0]);
    }
    let error = |index: usize| {
        let mut errors: Vec<f64> = done.iter().map(|trial| trial.error[index]).collect();
        errors.sort_by(f64::total_cmp);
        format!("{:.1} / {:.1} %", 100.0 * errors[errors.len() - 1], 100.0 * errors[errors.len() / 2])
    };
    let most = |of: &dyn Fn(&Trial) -> f64| worst(done.iter().map(|trial| of(trial)));
    let rest = |index: usize| 1e4 * most(&|trial| trial.rest[index]);
    let restless = done.iter().filter(|trial| trial.rest.iter().any(|&rest| rest.is_nan() || rest > AT_REST)).count();
    let faults: Vec<_> = done.iter().filter_map(|trial| trial.fault.as_ref()).collect();
    let fault = faults.first().map_or(String::new(), |fault| format!(": {fault}"));
    format!(
        "| {name} | {} | {} | {:.0} / {:.0} | {restless} of {} | {:.0} ms, {:.1} % | {:.0} | {:.0} ms | {}{fault}{} |",
        error(0),
        error(1),
        rest(0),
        rest(1),
        done.len(),
        1e3 * most(&|trial| trial.settling),
        100.0 * most(&|trial| trial.overshoot),
        1e4 * most(&|trial| trial.wall),
        1e3 * most(&|trial| trial.bump),
        faults.len(),
        refused.first().map_or(String::new(), |reason| format!("; {} refused: {reason}", refused.len())),
    )
}
