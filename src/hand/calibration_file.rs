//! What was found into the configuration file: only keys that changed, in the finger's own table, comments and layout kept.

use crate::hand::{HandError, read};
use crate::model::configuration::{Configuration, ConfiguredFinger};
use std::fs;
use std::io::{self, Write};
use std::path::Path;
use toml_edit::{Array, DocumentMut, Formatted, Item, Table, TableLike, Value};

/// Significant digits that are written: more than any routine finds.
const DIGITS: usize = 6;

/// One key that calibration may change.
struct Found {
    section: &'static str,
    key: &'static str,
    /// None of them: the key is left out.
    values: Vec<Value>,
    /// Whether the values stand in an array.
    array: bool,
}

/// Writes what calibration or a search for the bound of Kx has found: the keys that differ between the file at `path` and
/// `calibrated`.
///
/// # Errors
/// [`HandError::Store`], or what [`read`] says; the file is as it was then.
pub fn store(path: &Path, calibrated: &Configuration) -> Result<(), HandError> {
    let failed = |source| HandError::Store { path: path.to_path_buf(), source };
    let before = read(path)?;
    let text = fs::read_to_string(path).map_err(failed)?;
    // It was parsed a moment ago; if somebody has changed it since, that is an error of reading.
    let mut document: DocumentMut = text.parse().map_err(|error| failed(io::Error::other(error)))?;
    for (index, (before, now)) in before.fingers.iter().zip(&calibrated.fingers).enumerate() {
        write_finger(&mut document, index + 1, before, now).map_err(failed)?;
    }
    replace(path, &document.to_string()).map_err(failed)
}

fn write_finger(
    document: &mut DocumentMut,
    number: usize,
    before: &ConfiguredFinger,
    now: &ConfiguredFinger,
) -> io::Result<()> {
    for (old, new) in keys(before).into_iter().zip(keys(now)) {
        if new.values.is_empty() || same(&old.values, &new.values) {
            continue;
        }
        let fingers = child(document.as_table_mut(), "finger")?;
        let finger = child(fingers, &number.to_string())?;
        let section = child(finger, new.section)?;
        if !new.array {
            set(section, new);
            continue;
        }
        match section.get_mut(new.key).and_then(Item::as_array_mut) {
            Some(array) if array.len() == new.values.len() => {
                for (place, value) in new.values.into_iter().enumerate() {
                    array.replace(place, value);
                }
            }
            _ => {
                section.insert(new.key, Item::Value(Value::Array(new.values.into_iter().collect::<Array>())));
            }
        }
    }
    Ok(())
}

/// A key with one value, whose comments stay.
fn set(section: &mut dyn TableLike, found: Found) {
    for mut value in found.values {
        match section.get_mut(found.key).and_then(Item::as_value_mut) {
            Some(old) => {
                *value.decor_mut() = old.decor().clone();
                *old = value;
            }
            None => {
                section.insert(found.key, Item::Value(value));
            }
        }
    }
}

/// Everything that calibration and `sun2xp bound` find.
fn keys(finger: &ConfiguredFinger) -> Vec<Found> {
    let whole = |values: &[i32]| values.iter().map(|&value| i64::from(value).into()).collect();
    let signs = |values: &[i8]| values.iter().map(|&value| i64::from(value).into()).collect();
    let numbers = |values: &[f64]| values.iter().map(|&value| rounded(value)).collect();
    let found = |section, key, values| Found { section, key, values, array: true };
    vec![
        found("motor", "sign", signs(&finger.motor.sign)),
        found("encoder", "sign", signs(&finger.encoder.sign)),
        found("encoder", "zero", whole(&finger.encoder.zero)),
        found("gauge", "newton_per_count", numbers(&finger.gauge.newton_per_count)),
        found("gauge", "zero", numbers(&finger.gauge.zero)),
        found("tendon", "stiffness", numbers(&finger.tendon.stiffness)),
        Found { array: false, ..found("tendon", "stiffness_tolerance", numbers(&[finger.tendon.stiffness_tolerance])) },
        found("friction", "motor_coulomb", numbers(&finger.friction.motor_coulomb)),
        found("friction", "conduit", numbers(&finger.friction.conduit)),
        found("friction", "joint_coulomb", numbers(&finger.friction.joint_coulomb)),
        Found { array: false, ..found("stiffness", "bound", numbers(finger.stiffness.bound.as_slice())) },
    ]
}

/// To so many significant digits.
fn rounded(value: f64) -> Value {
    let digits = DIGITS - 1;
    // The text of a finite number is one.
    Value::Float(Formatted::new(format!("{value:.digits$e}").parse().unwrap_or(value)))
}

fn same(one: &[Value], other: &[Value]) -> bool {
    one.len() == other.len()
        && one.iter().zip(other).all(|(one, other)| match (one, other) {
            (Value::Float(one), Value::Float(other)) => one.value() == other.value(),
            (Value::Integer(one), Value::Integer(other)) => one.value() == other.value(),
            _ => false,
        })
}

/// The table behind a key; a new one, without a header of its own until it has keys, where there is none.
fn child<'a>(parent: &'a mut dyn TableLike, key: &str) -> io::Result<&'a mut dyn TableLike> {
    if !parent.contains_key(key) {
        let mut table = Table::new();
        table.set_implicit(true);
        parent.insert(key, Item::Table(table));
    }
    let table = parent.get_mut(key).and_then(Item::as_table_like_mut);
    table.ok_or_else(|| io::Error::other(format!("`{key}` is no table")))
}

/// Puts a file with this text in the place of the one at `path`: readers see the old one or the new one, whole, and so does
/// who looks after a power cut.
fn replace(path: &Path, text: &str) -> io::Result<()> {
    // A symbolic link stays one.
    let path = &path.canonicalize()?;
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.new", std::process::id()));
    let new = path.with_file_name(name);
    let written = (|| {
        let mut file = fs::File::create(&new)?;
        file.set_permissions(fs::metadata(path)?.permissions())?;
        file.write_all(text.as_bytes())?;
        file.sync_all()?;
        fs::rename(&new, path)
    })();
    if written.is_err() {
        // Nothing more can be done about a file that cannot be removed.
        let _ = fs::remove_file(&new);
    }
    written
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stored(text: &str, change: impl FnOnce(&mut Configuration)) -> String {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("hand.toml");
        fs::write(&path, text).expect("written");
        let mut configuration = read(&path).expect("usable");
        change(&mut configuration);
        store(&path, &configuration).expect("stored");
        let files = fs::read_dir(folder.path()).expect("a folder").count();
        assert_eq!(files, 1, "no temporary file is left");
        let again = read(&path).expect("still usable");
        for (one, other) in again.fingers.iter().zip(&configuration.fingers) {
            assert!((0..4).all(|i| (one.tendon.stiffness[i] - other.tendon.stiffness[i]).abs() < 1e-3));
            assert_eq!(one.encoder, other.encoder);
            assert_eq!(one.motor.sign, other.motor.sign);
        }
        fs::read_to_string(&path).expect("there")
    }

    const FILE: &str = "# The hand in the corner.\n\n[hand]\nrate = 500 # slow cable\n\n[finger.encoder]\nzero = [1, 2, 3, 4]\n\n\
                        [finger.2]\nport = \"simulated\"   # for now\n[finger.2.tendon]\n# As measured in May:\n\
                        stiffness = [ 300.0, 300, # new\n  310.0, 300.0 ] # N/cm\n";

    #[test]
    fn nothing_found_changes_nothing() {
        assert_eq!(stored(FILE, |_| {}), FILE);
    }

    #[test]
    fn what_is_found_replaces_its_numbers_and_nothing_else() {
        let text = stored(FILE, |hand| hand.fingers[1].tendon.stiffness = [330.0, 301.123_456_789, 310.0, 300.0]);
        let expected = FILE.replace("[ 300.0, 300,", "[ 330.0, 301.123,");
        assert_eq!(text, expected);
    }

    #[test]
    fn what_all_fingers_share_is_overridden_for_one() {
        let text = stored(FILE, |hand| {
            hand.fingers[0].encoder.zero = [5, 6, 7, -8];
            hand.fingers[0].motor.sign = [1, -1, 1, 1];
        });
        assert!(text.starts_with(FILE), "{text}");
        assert!(text.contains("[finger.1.encoder]\nzero = [5, 6, 7, -8]"), "{text}");
        assert!(text.contains("[finger.1.motor]\nsign = [1, -1, 1, 1]"), "{text}");
    }

    #[test]
    fn inline_tables_take_it_too() {
        let text = stored("finger.3 = { encoder = { zero = [0, 0, 0, 0] } }\n", |hand| {
            hand.fingers[2].encoder.zero = [9, 0, 0, 0];
            hand.fingers[2].friction.conduit = [0.07; 4];
        });
        assert!(text.contains("zero = [9, 0, 0, 0]"), "{text}");
        assert!(text.contains("conduit = [0.07, 0.07, 0.07, 0.07]"), "{text}");
    }

    #[test]
    fn a_single_number_keeps_its_comment_or_is_added() {
        let file = "[finger.1.stiffness]\nbound = 4.0 # N/cm, by hand\n";
        let text = stored(file, |hand| {
            hand.fingers[0].stiffness.bound = Some(8.300000001);
            hand.fingers[2].stiffness.bound = Some(7.0);
        });
        let expected = "[finger.1.stiffness]\nbound = 8.3 # N/cm, by hand\n\n[finger.3.stiffness]\nbound = 7.0\n";
        assert_eq!(text, expected);
        // What was never found is not written, nor taken away.
        assert_eq!(stored(file, |hand| hand.fingers[0].stiffness.bound = None), file);
    }

    #[test]
    fn a_folder_that_cannot_be_written_is_named() {
        let error = store(Path::new("/proc/version"), &Configuration::default());
        assert!(error.is_err());
    }
}
