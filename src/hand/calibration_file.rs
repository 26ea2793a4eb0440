//! Stores the results of calibrations in the configuration file: writes only their keys, in the finger's own table, and
//! keeps comments and layout.

mod editing;

use super::configuration_file::{FingersWithIo, LARGEST, parse, to_document};
use crate::files::{UpdateError, update_file, with_line_ends_of};
use crate::hand::ConfigurationError;
use crate::hand::found::{Found, FoundValue, Misfit};
use crate::model::configuration::{Configuration, ConfiguredFinger};
use editing::{child, same, set, written};
use std::path::Path;
use toml_edit::{DocumentMut, Item, Value};

/// Stores those results that differ from the values in the configuration file at `path`. Everything else in the file is
/// kept, including changes that others have made since it was read. Several processes may store at the same time: each
/// waits for the others, for at most 30 seconds.
///
/// # Errors
/// Returns an error if the file cannot be read, used or written. Returns [`ConfigurationError::Mismatch`] if the file
/// has changed so that the results do not apply to it. After an error the file is unchanged, with one exception: if
/// only the flush of its folder fails, the new file is in place.
pub fn store_findings(path: &Path, found: &[Found]) -> Result<(), ConfigurationError> {
    update_file(path, LARGEST, |text| change(path, text, found)).map_err(|error| match error {
        UpdateError::File(source) => ConfigurationError::Unwritable { path: path.to_path_buf(), source },
        UpdateError::Change(error) => error,
    })
}

/// Returns the text with the results, or `None` if the text contains them already.
fn change(path: &Path, text: &str, found: &[Found]) -> Result<Option<String>, ConfigurationError> {
    let file = || path.to_path_buf();
    let with_io = found.iter().fold(FingersWithIo::default(), |all, found| all.and(found.with_io()));
    let before = parse(text, with_io).map_err(|wrong| ConfigurationError::Invalid {
        file: file(),
        line: wrong.line(text),
        reason: wrong.to_string(),
    })?;
    if let Some(Misfit { key, was, is }) = found.iter().find_map(|found| found.misfit(&before)) {
        return Err(ConfigurationError::Mismatch { path: file(), key, was, is });
    }
    let unusable = |reason: String| ConfigurationError::Invalid { file: file(), line: None, reason };
    let mut document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| unusable(error.to_string()))?;
    let mut changed = false;
    for found in found {
        changed |= write_finger(&mut document, found, &before).map_err(unusable)?;
    }
    if !changed {
        return Ok(None);
    }
    let changed = with_line_ends_of(text, document.to_string());
    match parse(&changed, with_io) {
        Ok(_) => Ok(Some(changed)),
        Err(wrong) => Err(unusable(format!("with the new calibration, {wrong}"))),
    }
}

/// Writes the results of one finger. Returns whether anything changed.
fn write_finger(document: &mut DocumentMut, found: &Found, before: &Configuration) -> Result<bool, String> {
    let number = found.finger();
    let present = &before.fingers[number.index()];
    let mut changed = false;
    for FoundValue { section, key, numbers } in found.values() {
        let present = numbers_at(present, section, key);
        let (values, array) = written(numbers, &present);
        if same(&values, &present) {
            continue;
        }
        changed = true;
        let fingers = child(document.as_table_mut(), "finger")?;
        let finger = child(fingers, &number.to_string())?;
        set(child(finger, section)?, key, values, array, &present);
    }
    Ok(changed)
}

/// The numbers at a key, including default values. There are none if the key is not set and has no default.
fn numbers_at(finger: &ConfiguredFinger, section: &str, key: &str) -> Vec<f64> {
    let number = |value: &Value| value.as_float().or(value.as_integer().map(|whole| whole as f64));
    let document = to_document(finger).unwrap_or_default();
    let value = document.get(section).and_then(|section| section.get(key)).and_then(Item::as_value);
    match value {
        Some(Value::Array(values)) => {
            let rows = values.iter().filter_map(Value::as_array).flatten();
            values.iter().chain(rows).filter_map(number).collect()
        }
        Some(value) => number(value).into_iter().collect(),
        None => Vec::new(),
    }
}

#[cfg(test)]
mod tests;
