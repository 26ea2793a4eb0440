//! Searches for parameters of state feedback (`Numbers`) that suit a set of fingers instead of one finger.
//!
//!     cargo bench --bench stiffness -- --search [TEXT] [--numbers TOML] [--poses N] [--seeds N] [--keys TOML]
//!
//! The cost of a set of numbers is the sum of (worst value / goal)^4 over all measures and fingers. The exponent makes
//! the cost depend mostly on the measures that miss their goals by the largest factor. The search varies one number at
//! a time by a factor and keeps every change that lowers the cost. When a pass over all numbers lowers the cost by less
//! than 1 %, the search continues with a smaller factor.

use crate::Arguments;
use crate::cases::Case;
use crate::overlay::overlaid;
use crate::parallel::worst;
use crate::trials::{self, Extent, Trial};
use crate::truths_table;
use std::error::Error;
use sun2xp::control::Numbers;
use sun2xp::model::configuration::ConfiguredFinger;

/// Largest factor by which a number changes in a step, and the factor at which the search ends.
const STRIDES: [f64; 2] = [1.25, 1.04];

/// A measure counts as at most this multiple of its goal. Some measures cannot be improved by numbers, such as the
/// error of a finger whose tendons are softer than configured.
const MOST: f64 = 3.0;

pub fn run(arguments: &Arguments, only: &str) -> Result<(), Box<dyn Error>> {
    let cases = truths_table::cases(arguments, 2, arguments.seeds.min(2))?;
    let rate = cases[0].rate;
    let start = cases[0].numbers.map_or_else(|| truths_table::default_numbers(rate), Ok)?;
    let adjust = |finger: &mut ConfiguredFinger| *finger = overlaid(finger, &arguments.keys).expect("keys of a finger");
    let cost = |numbers: &Numbers| -> f64 {
        let cases: Vec<_> = cases.iter().map(|case| Case { numbers: Some(*numbers), ..*case }).collect();
        truths_table::wanted(only)
            .map(|truth| cost_of(&trials::trials(&cases, truth, arguments.identified, Extent::Search, &adjust)))
            .sum()
    };
    let keys: Vec<String> = toml_edit::ser::to_document(&start)?.iter().map(|(key, _)| key.to_owned()).collect();
    let (mut best, mut least, mut stride) = (start, cost(&start), STRIDES[0]);
    println!("{least:.2} at the start");
    while stride > STRIDES[1] {
        let before = least;
        for key in &keys {
            for factor in [stride, stride.recip()] {
                let tried = scaled(&best, key, factor)?;
                let found = cost(&tried);
                if found < least {
                    (best, least) = (tried, found);
                    println!("{least:.2} with {key} x{factor:.3}");
                    break;
                }
            }
        }
        if least > 0.99 * before {
            stride = stride.sqrt();
        }
    }
    println!("{}", toml_edit::ser::to_string(&best)?);
    Ok(())
}

/// Returns the cost of one finger. The constants are the goals, in the units of [`Trial`].
fn cost_of(all: &[Vec<Trial>]) -> f64 {
    let most = |of: &dyn Fn(&Trial) -> f64, goal: f64| (worst(all.iter().flatten().map(of)) / goal).min(MOST).powi(4);
    most(&|trial| worst(trial.error), 0.1)
        + most(&|trial| worst(trial.rest), 0.005)
        + most(&|trial| trial.settling, 0.2)
        + most(&|trial| trial.overshoot, 0.1)
        + most(&|trial| trial.wall, 0.005)
        + most(&|trial| trial.bump, 0.05)
        + most(&|trial| f64::from(u8::from(trial.fault.is_some())), 0.5)
}

/// Returns the numbers with one of them multiplied by `factor`.
fn scaled(numbers: &Numbers, key: &str, factor: f64) -> Result<Numbers, Box<dyn Error>> {
    let document = toml_edit::ser::to_document(numbers)?;
    let value = document[key].as_float().unwrap_or(0.0) * factor;
    overlaid(numbers, &format!("{key} = {value:?}"))
}
