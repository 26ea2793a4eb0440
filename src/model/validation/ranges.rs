//! Checks of single values: numbers against their ranges, and paths.

use crate::model::Shown;
use crate::model::configuration::Unusable;

/// The longest path of a port or a folder, bytes. Paths below /dev are shorter than 100 bytes.
const LONGEST_PATH: usize = 1000;

pub(super) fn unusable<T>(key: &'static str, reason: String) -> Result<T, Unusable> {
    Err(Unusable { key, reason })
}

pub(super) fn path(key: &'static str, path: &str) -> Result<(), Unusable> {
    if path.len() > LONGEST_PATH {
        return unusable(key, format!("{} is longer than {LONGEST_PATH} bytes: set a shorter path", Shown(path)));
    }
    match path.chars().any(char::is_control) {
        true => unusable(key, format!("{} contains a control character: remove it", Shown(path))),
        false => Ok(()),
    }
}

pub(super) fn within(key: &'static str, value: f64, low: f64, high: f64, unit: &str) -> Result<(), Unusable> {
    // This form of the comparison rejects NaN.
    if value >= low && value <= high {
        return Ok(());
    }
    // {:?} writes 1e308 with its exponent, where {} would write 309 digits.
    unusable(key, format!("{value:?} is outside {low} to {high} {unit}").trim_end().into())
}

pub(super) fn each(key: &'static str, values: &[f64], low: f64, high: f64, unit: &str) -> Result<(), Unusable> {
    values.iter().try_for_each(|&value| within(key, value, low, high, unit))
}
