//! The table of fingers that differ from their configuration, as Markdown.

use crate::Arguments;
use crate::cases::Case;
use crate::overlay::overlaid;
use crate::parallel::worst;
use crate::trials::{self, Extent, Trial};
use crate::truths::{TRUTHS, Truth};
use std::error::Error;
use std::time::Instant;
use sun2xp::control::Numbers;
use sun2xp::model::configuration::{ConfiguredController, ConfiguredFinger, Scheme};

/// A finger whose motion is at most this, cm rms, counts as at rest.
const AT_REST: f64 = 0.005;

pub fn run(arguments: &Arguments, only: &str, begun: Instant) -> Result<(), Box<dyn Error>> {
    let extent = if arguments.short { Extent::Short } else { Extent::All };
    overlaid(&ConfiguredFinger::default(), &arguments.keys)?;
    let adjust = |finger: &mut ConfiguredFinger| *finger = overlaid(finger, &arguments.keys).expect("checked before");
    let columns = [
        "finger (in each cell: the worst of all seeds, then the median over the seeds of the worst pose of each seed)",
        "error at 3 N/cm",
        "error at 6 N/cm",
        "rest at 3 N/cm, um",
        "rest at 6 N/cm, um",
        "not at rest",
        "settling, ms",
        "overshoot",
        "step ends off by",
        "at walls, um",
        "tensions back after a bump, ms",
        "faults",
    ];
    println!("| {} |\n|{}", columns.join(" | "), "---|".repeat(columns.len()));
    let cases = cases(arguments, 12, arguments.seeds)?;
    for truth in wanted(only) {
        println!("{}", row(truth.name, &trials::trials(&cases, truth, arguments.identified, extent, &adjust)));
    }
    eprintln!("{:.0} s", begun.elapsed().as_secs_f64());
    Ok(())
}

/// Returns the fingers whose names contain one of several texts separated by semicolons.
pub fn wanted(only: &str) -> impl Iterator<Item = &'static Truth> {
    TRUTHS.iter().filter(move |truth| only.split(';').any(|text| truth.name.contains(text.trim())))
}

/// Returns one case for each seed.
pub fn cases(arguments: &Arguments, poses: usize, seeds: u64) -> Result<Vec<Case>, Box<dyn Error>> {
    let rate = arguments.rates.as_ref().map_or(1000.0, |rates| rates[0]);
    let scheme = arguments.controllers.last().copied().unwrap_or(Scheme::StateFeedback);
    let numbers = match arguments.numbers.is_empty() {
        true => None,
        false => Some(overlaid(&default_numbers(rate)?, &arguments.numbers)?),
    };
    let (law, poses) = (arguments.law, arguments.poses.unwrap_or(poses));
    Ok((0..seeds).map(|seed| Case { scheme, rate, poses, seed: arguments.seed + seed * 1000, law, numbers }).collect())
}

/// Returns the library's numbers of state feedback at `rate`, Hz.
pub fn default_numbers(rate: f64) -> Result<Numbers, Box<dyn Error>> {
    Numbers::new(&ConfiguredController::default(), rate).map_err(|unusable| unusable.reason.into())
}

/// Returns a row of the table. `all` has the results of each seed.
fn row(name: &str, all: &[Vec<Trial>]) -> String {
    let refused: Vec<_> = all.iter().flatten().filter_map(|trial| trial.refused.as_ref()).collect();
    let done: Vec<&Vec<Trial>> = all.iter().filter(|seed| seed.iter().all(|trial| trial.refused.is_none())).collect();
    if done.is_empty() {
        return format!("| {name} | refused: {} |", refused[0]);
    }
    let cell = |of: &dyn Fn(&Trial) -> f64, digits: usize, unit: &str| {
        let mut seeds: Vec<f64> = done.iter().map(|seed| worst(seed.iter().map(of))).collect();
        seeds.sort_by(f64::total_cmp);
        format!("{:.digits$}, {:.digits$}{unit}", seeds[seeds.len() - 1], seeds[seeds.len() / 2])
    };
    let trials = || done.iter().copied().flatten();
    let restless = trials().filter(|trial| trial.rest.iter().any(|&rest| rest.is_nan() || rest > AT_REST)).count();
    let faults: Vec<_> = trials().filter_map(|trial| trial.fault.as_ref()).collect();
    let fault = faults.first().map_or(String::new(), |fault| format!(": {fault}"));
    let cells = [
        name.to_owned(),
        cell(&|trial| 100.0 * trial.error[0], 1, " %"),
        cell(&|trial| 100.0 * trial.error[1], 1, " %"),
        cell(&|trial| 1e4 * trial.rest[0], 0, ""),
        cell(&|trial| 1e4 * trial.rest[1], 0, ""),
        format!("{restless} of {}", trials().count()),
        cell(&|trial| 1e3 * trial.settling, 0, ""),
        cell(&|trial| 100.0 * trial.overshoot, 1, " %"),
        cell(&|trial| 100.0 * trial.off, 1, " %"),
        cell(&|trial| 1e4 * trial.wall, 0, ""),
        cell(&|trial| 1e3 * trial.bump, 0, ""),
        format!(
            "{}{fault}{}",
            faults.len(),
            refused.first().map_or(String::new(), |reason| format!("; {} refused: {reason}", refused.len()))
        ),
    ];
    format!("| {} |", cells.join(" | "))
}
