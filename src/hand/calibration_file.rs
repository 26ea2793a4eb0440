//! Stores results in the configuration file: writes only their keys, in the finger's own table, and keeps comments and
//! layout.

mod editing;

use super::configuration_file::{LARGEST, parse};
use crate::files::{UpdateError, update_file};
use crate::hand::ConfigurationError;
use crate::hand::found::{Found, FoundValue, Misfit};
use crate::model::configuration::{Configuration, ConfiguredFinger};
use editing::{child, same, set, written};
use std::path::Path;
use toml_edit::{DocumentMut, Item, Value};

/// Some editors put this at the beginning of a file.
const BYTE_ORDER_MARK: char = '\u{feff}';

/// Writes those results into the configuration file at `path` that differ from the values in the file. Everything else
/// in the file is kept, including changes that others have made since it was read. Several processes may store at the
/// same time: each waits for the others, for at most 30 seconds.
///
/// # Errors
/// Returns an error if the file cannot be read, used or written. Returns [`ConfigurationError::Mismatch`] if the file
/// has changed so that the results do not apply to it. After an error the file is unchanged.
pub fn store_findings(path: &Path, found: &[Found]) -> Result<(), ConfigurationError> {
    update_file(path, LARGEST, |text| change(path, text, found)).map_err(|error| match error {
        UpdateError::File(source) => ConfigurationError::Unwritable { path: path.to_path_buf(), source },
        UpdateError::Change(error) => error,
    })
}

/// Returns the text with the results, or `None` if the text contains them already.
fn change(path: &Path, text: &str, found: &[Found]) -> Result<Option<String>, ConfigurationError> {
    let file = || path.to_path_buf();
    let before = parse(text).map_err(|wrong| ConfigurationError::Invalid {
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
    let changed = like(text, document.to_string());
    match parse(&changed) {
        Ok(_) => Ok(Some(changed)),
        Err(wrong) => Err(unusable(format!("with the new calibration, {wrong}"))),
    }
}

/// Gives a changed text the byte order mark and the line ends of the original, which the parser drops.
fn like(before: &str, mut changed: String) -> String {
    if before.contains("\r\n") && before.matches("\r\n").count() == before.matches('\n').count() {
        changed = changed.replace("\r\n", "\n").replace('\n', "\r\n");
    }
    match before.strip_prefix(BYTE_ORDER_MARK) {
        Some(_) if !changed.starts_with(BYTE_ORDER_MARK) => format!("{BYTE_ORDER_MARK}{changed}"),
        _ => changed,
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

/// The numbers at a key, including default values. It is empty if the key is not set.
fn numbers_at(finger: &ConfiguredFinger, section: &str, key: &str) -> Vec<f64> {
    let number = |value: &Value| value.as_float().or(value.as_integer().map(|whole| whole as f64));
    let document = toml_edit::ser::to_document(finger).unwrap_or_default();
    let value = document.get(section).and_then(|section| section.get(key)).and_then(Item::as_value);
    match value {
        Some(Value::Array(values)) => values.iter().filter_map(number).collect(),
        Some(value) => number(value).into_iter().collect(),
        None => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::{Findings, Identified, Signs, Zeros};
    use crate::model::FingerNumber;
    use nalgebra::Vector3;
    use std::fs;

    /// Stores `found` in a file that contains `text`, and returns the text of the file afterwards.
    fn try_to_store(text: &str, found: &[Found]) -> Result<String, ConfigurationError> {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("hand.toml");
        fs::write(&path, text).expect("written");
        let stored = store_findings(&path, found);
        let files = fs::read_dir(folder.path()).expect("a folder").count();
        assert_eq!(files, 1, "no temporary file is left");
        let after = fs::read_to_string(&path).expect("there");
        assert!(stored.is_ok() || after == text, "refused and changed");
        stored.map(|()| after)
    }

    fn stored(text: &str, found: &[Found]) -> String {
        let after = try_to_store(text, found).unwrap_or_else(|error| panic!("{error}"));
        parse(&after).expect("still usable");
        // Storing again changes nothing.
        assert_eq!(try_to_store(&after, found).expect("stored"), after);
        after
    }

    fn zeros(finger: FingerNumber, encoder: [i32; 4], gauge: f64) -> Found {
        let findings =
            Findings::Zeros(Zeros { encoder, gauge: [gauge; 4], joint_error: Vector3::zeros(), range_error: None });
        Found::by_calibration(&findings, finger, &Configuration::default())
    }

    fn signs(finger: FingerNumber, motor: [i8; 4], gauge: [i8; 4]) -> Found {
        let findings = Findings::Signs(Signs { motor, encoder: [1; 4], gauge });
        Found::by_calibration(&findings, finger, &Configuration::default())
    }

    fn identified(finger: FingerNumber, stiffness: [f64; 4], conduit: f64) -> Found {
        let findings = Findings::Identified(Identified {
            tendon_stiffness: stiffness.into(),
            stiffness_tolerance: 0.03,
            travel_residual: 0.0,
            motor_coulomb: [0.07; 4].into(),
            conduit: [conduit; 4].into(),
            pulley: [0.0; 4].into(),
            gauge_gain: [1.0; 4].into(),
            motor_ratio: [1.0; 4].into(),
            joint_coulomb: Vector3::repeat(0.05),
            joint_viscous: Vector3::repeat(0.05),
            moment_arms: None,
        });
        let mut configuration = Configuration::default();
        findings.apply(&mut configuration.fingers[finger.index()]);
        Found::by_calibration(&findings, finger, &configuration)
    }

    fn bound(finger: FingerNumber, bound: f64) -> Found {
        Found::bound(bound, finger, &Configuration::default())
    }

    const FILE: &str = "# The hand in the corner.\n\n[hand]\nrate = 500 # slow cable\n\n[finger.encoder]\n\
         zero = [1, 2, 3, 4]\n\n[finger.2]\nport = \"simulated\"   # for now\n[finger.2.tendon]\n\
         # As measured in May:\nstiffness = [ 300.0, 300, # new\n  310.0, 300.0 ] # N/cm\n";

    #[test]
    fn values_that_are_present_change_nothing() {
        assert_eq!(stored(FILE, &[]), FILE);
        assert_eq!(
            stored(FILE, &[zeros(FingerNumber::ONE, [1, 2, 3, 4], 0.0), signs(FingerNumber::THREE, [1; 4], [1; 4])]),
            FILE
        );
    }

    #[test]
    fn results_replace_their_numbers_and_nothing_else() {
        let text = stored(FILE, &[identified(FingerNumber::TWO, [330.0, 301.123_456_789, 310.0, 300.0], 0.05)]);
        let expected = FILE.replace("[ 300.0, 300,", "[ 330.0, 301.123,");
        assert_eq!(text, expected + "stiffness_tolerance = 0.03\n");
    }

    #[test]
    fn shared_values_are_overridden_for_one_finger() {
        let text = stored(
            FILE,
            &[zeros(FingerNumber::ONE, [5, 6, 7, -8], 0.0), signs(FingerNumber::ONE, [1, -1, 1, 1], [1; 4])],
        );
        assert!(text.starts_with(FILE), "{text}");
        assert!(text.contains("[finger.1.encoder]\nzero = [5, 6, 7, -8]"), "{text}");
        assert!(text.contains("[finger.1.motor]\nsign = [1, -1, 1, 1]"), "{text}");
    }

    #[test]
    fn inline_tables_take_it_too() {
        let text = "finger.3 = { encoder = { zero = [0, 0, 0, 0] } }\n";
        let text = stored(
            text,
            &[zeros(FingerNumber::THREE, [9, 0, 0, 0], 0.0), identified(FingerNumber::THREE, [300.0; 4], 0.07)],
        );
        assert!(text.contains("zero = [9, 0, 0, 0]"), "{text}");
        assert!(text.contains("conduit = [0.07, 0.07, 0.07, 0.07]"), "{text}");
    }

    #[test]
    fn a_single_number_keeps_its_comment_or_is_added() {
        let file = "[finger.1.stiffness]\nbound = 4.0 # N/cm, by hand\n";
        let text = stored(file, &[bound(FingerNumber::ONE, 8.300000001), bound(FingerNumber::THREE, 7.0)]);
        let expected = "[finger.1.stiffness]\nbound = 8.3 # N/cm, by hand\n\n[finger.3.stiffness]\nbound = 7.0\n";
        assert_eq!(text, expected);
    }

    #[test]
    fn others_findings_stay() {
        // All results were found before any of them was stored.
        let (first, second) =
            (zeros(FingerNumber::ONE, [5, 6, 7, 8], 200.0), zeros(FingerNumber::TWO, [9, 9, 9, 9], 190.0));
        let bound = Found::bound(7.5, FingerNumber::ONE, &parse(FILE).expect("usable"));
        let text = stored(&stored(FILE, &[first]), &[second, bound]);
        let hand = parse(&text).expect("usable");
        assert_eq!(hand.fingers.each_ref().map(|finger| finger.encoder.zero[0]), [5, 9, 1]);
        assert_eq!(hand.fingers.each_ref().map(|finger| finger.gauge.zero[0]), [200.0, 190.0, 0.0]);
        assert_eq!(hand.fingers.each_ref().map(|finger| finger.stiffness.bound), [Some(7.5), None, None]);
    }

    #[test]
    fn signs_are_given_to_the_sizes_that_are_there() {
        let file = "[finger.1.gauge]\nnewton_per_count = [0.0312345678, 0.02, -0.03, 0.04] # measured\n";
        let text = stored(file, &[signs(FingerNumber::ONE, [1; 4], [1, -1, -1, 1])]);
        assert_eq!(text, file.replace("0.02,", "-0.02,"));
    }

    #[test]
    fn byte_order_marks_and_line_ends_are_kept() {
        for file in [FILE.replace('\n', "\r\n"), format!("\u{feff}{FILE}")] {
            let text = stored(&file, &[zeros(FingerNumber::ONE, [5, 6, 7, 8], 0.0)]);
            assert!(text.starts_with(&file), "{text:?}");
            assert_eq!(text.contains("\nzero = [5, 6, 7, 8]\n"), !file.contains('\r'), "{text:?}");
        }
        let text = stored("[hand]\nrate = 1000 # no line end", &[zeros(FingerNumber::ONE, [5, 6, 7, 8], 0.0)]);
        assert_eq!(text, "[hand]\nrate = 1000 # no line end\n\n[finger.1.encoder]\nzero = [5, 6, 7, 8]\n");
    }

    #[test]
    fn a_file_that_no_longer_fits_is_unchanged_and_the_reason_is_reported() {
        let radius = "[finger.1.geometry]\nmotor_radius = [0.05, 0.05, 0.05, 0.05]\n";
        let error =
            try_to_store(radius, &[zeros(FingerNumber::ONE, [5; 4], 0.0)]).expect_err("other motors").to_string();
        assert!(error.contains("finger.1.geometry.motor_radius is [0.05, 0.05, 0.05, 0.05] there"), "{error}");
        // The change does not affect finger 2.
        stored(radius, &[zeros(FingerNumber::TWO, [5; 4], 0.0)]);
        let error = try_to_store("[hand]\nrate = 500\n", &[bound(FingerNumber::TWO, 7.0)])
            .expect_err("another rate")
            .to_string();
        assert!(error.contains("hand.rate is 500 there, and was 1000 during the calibration"), "{error}");
        for (text, line, reason) in
            [("[hand]\nrate = \n", Some(2), ""), ("\n[finger.3.tendon]\nmaximum = 8\n", Some(3), "for its pretension")]
        {
            match try_to_store(text, &[zeros(FingerNumber::ONE, [5; 4], 0.0)]).expect_err("unusable") {
                ConfigurationError::Invalid { line: found, reason: told, .. } => {
                    assert!(found == line && told.contains(reason), "{found:?} {told}");
                }
                other => panic!("{other}"),
            }
        }
        let error = try_to_store("", &[bound(FingerNumber::ONE, 1e9)]).expect_err("beyond its range").to_string();
        assert!(error.contains("with the new calibration, finger.1.stiffness.bound"), "{error}");
    }

    #[test]
    fn a_failed_write_is_named() {
        let error = store_findings(Path::new("/proc/version"), &[]).expect_err("no text of a configuration");
        assert!(error.to_string().contains("/proc/version"), "{error}");
    }
}
