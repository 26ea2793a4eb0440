//! Writes what a step has found into the configuration file, each key with a comment.

use crate::failure::{Failure, unwritable};
use std::path::Path;
use sun2xp::control::Controller;
use sun2xp::files::{UpdateError, update_file, with_line_ends_of};
use sun2xp::hand::parse_configuration;
use sun2xp::model::configuration::ConfiguredFinger;
use toml_edit::{Array, DocumentMut, Formatted, Item, Table, Value};

/// Largest configuration file, bytes.
pub const LARGEST: u64 = 1 << 20;
/// Every comment that this tool writes above a key begins with this text. A new comment replaces an older one above the
/// same key.
const MARK: &str = "# commission ";
/// Number of significant digits of a number.
const DIGITS: usize = 6;

/// Writes the keys of `after` that differ from `before` into the table of the finger, with a comment above each.
/// `comment` returns the comment of a key, for example of "gauge.zero". Everything else in the file is kept.
pub fn store(
    path: &Path,
    finger: i32,
    before: &ConfiguredFinger,
    after: &ConfiguredFinger,
    comment: &dyn Fn(&str) -> String,
) -> Result<(), Failure> {
    let (before, after) = (toml_edit::ser::to_document(before)?, toml_edit::ser::to_document(after)?);
    let changed = differences(&before, &after);
    if changed.is_empty() {
        return Ok(());
    }
    let change = |text: &str| with(text, finger, &changed, comment).map(Some);
    update_file(path, LARGEST, change).map_err(|error| match error {
        UpdateError::File(error) => unwritable(path, &error),
        UpdateError::Change(error) => error,
    })
}

/// A key of a section, and its new value.
struct Changed {
    section: String,
    key: String,
    value: Value,
}

/// Returns the keys whose values differ.
fn differences(before: &DocumentMut, after: &DocumentMut) -> Vec<Changed> {
    let mut changed = Vec::new();
    for (section, table) in after.iter() {
        let Some(table) = table.as_table_like() else { continue };
        for (key, value) in table.iter() {
            let Some(value) = value.as_value() else { continue };
            let old = before.get(section).and_then(|table| table.get(key)).and_then(Item::as_value);
            let text = |value: &Value| rounded(value).to_string();
            if old.map(text) != Some(text(value)) {
                changed.push(Changed { section: section.into(), key: key.into(), value: rounded(value) });
            }
        }
    }
    changed
}

/// Returns a copy of a value without the spaces and comments of its text. Floating-point numbers are rounded to
/// [`DIGITS`] significant digits.
fn rounded(value: &Value) -> Value {
    let digits = DIGITS - 1;
    match value {
        Value::Float(number) => {
            let number = *number.value();
            // The formatted text of a number can always be parsed.
            Value::Float(Formatted::new(format!("{number:.digits$e}").parse().unwrap_or(number)))
        }
        Value::Array(values) => Value::Array(values.iter().map(rounded).collect::<Array>()),
        Value::Integer(number) => Value::from(*number.value()),
        Value::Boolean(truth) => Value::from(*truth.value()),
        Value::String(text) => Value::from(text.value().as_str()),
        other => other.clone(),
    }
}

/// Returns the text with the changed keys.
fn with(text: &str, finger: i32, changed: &[Changed], comment: &dyn Fn(&str) -> String) -> Result<String, Failure> {
    let mut document: DocumentMut = text.parse()?;
    let fingers = table(document.as_table_mut(), "finger")?;
    let own = table(fingers, &finger.to_string())?;
    for Changed { section, key, value } in changed {
        let comment = comment(&format!("{section}.{key}"));
        let section = table(own, section)?;
        section.set_implicit(false);
        let kept = section.key(key).and_then(|key| key.leaf_decor().prefix()?.as_str().map(without_mark));
        let value = with_layout_of(section.get(key).and_then(Item::as_value), value.clone());
        section.insert(key, Item::Value(value));
        if let Some(mut key) = section.key_mut(key) {
            let kept = kept.unwrap_or_default();
            let gap = if kept.is_empty() || kept.ends_with('\n') { "" } else { "\n" };
            key.leaf_decor_mut().set_prefix(format!("{kept}{gap}{MARK}{comment}\n"));
        }
    }
    let text = with_line_ends_of(text, document.to_string());
    let configuration = parse_configuration(&text)
        .map_err(|error| format!("the results do not fit the configuration file: {error}"))?;
    // A hand would refuse to open with values with which no controller can be constructed.
    let found = configuration
        .fingers
        .get(finger as usize - 1)
        .ok_or_else(|| format!("the results have no finger {finger}. This is a defect of sun2xp: please report it"))?;
    Controller::new(found, configuration.hand.rate)
        .map_err(|unusable| format!("a hand would not open with the results: finger.{finger}.{unusable}"))?;
    Ok(text)
}

/// Returns a new value with the comments and spaces of the value that it replaces. Comments inside an array are kept if
/// the new array has the same length.
pub fn with_layout_of(old: Option<&Value>, new: Value) -> Value {
    let mut value = match (old, new) {
        (Some(Value::Array(old)), Value::Array(new)) if old.len() == new.len() => {
            let mut kept = old.clone();
            for (place, number) in new.into_iter().enumerate() {
                kept.replace(place, number);
            }
            Value::Array(kept)
        }
        (_, new) => new,
    };
    if let Some(old) = old {
        *value.decor_mut() = old.decor().clone();
    }
    value
}

/// Removes the comments of earlier runs.
fn without_mark(prefix: &str) -> String {
    prefix.lines().filter(|line| !line.starts_with(MARK)).map(|line| format!("{line}\n")).collect()
}

/// Returns the table with this key. A missing table is created. An inline table becomes a table with its own header.
pub fn table<'a>(parent: &'a mut Table, key: &str) -> Result<&'a mut Table, Failure> {
    let entry = parent.entry(key).or_insert_with(|| {
        let mut new = Table::new();
        new.set_implicit(true);
        Item::Table(new)
    });
    if let Item::Value(Value::InlineTable(inline)) = entry {
        *entry = Item::Table(std::mem::take(inline).into_table());
        if let Some(mut key) = parent.key_mut(key) {
            key.leaf_decor_mut().clear();
        }
    }
    let entry = parent
        .get_mut(key)
        .ok_or_else(|| format!("the table {key} could not be created. This is a defect of sun2xp: please report it"))?;
    entry
        .as_table_mut()
        .ok_or_else(|| format!("{key} is not a table in the configuration file: write it as one").into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn changed(change: impl Fn(&mut ConfiguredFinger), text: &str) -> String {
        let before = ConfiguredFinger::default();
        let mut after = before.clone();
        change(&mut after);
        let [before, after] = [&before, &after].map(|finger| toml_edit::ser::to_document(finger).expect("a document"));
        with(text, 2, &differences(&before, &after), &|key| format!("2026-11-22, motors: {key}")).expect("written")
    }

    #[test]
    fn a_key_gets_a_comment_and_everything_else_stays() {
        let text = "# my hand\n[hand]\nrate = 500 # slow\n\n[finger.2]\nport = \"simulated\"\n";
        let new = changed(|finger| finger.motor.sign[1] = -1, text);
        assert!(new.starts_with(text), "{new}");
        let rest = "\n[finger.2.motor]\n# commission 2026-11-22, motors: motor.sign\nsign = [1, -1, 1, 1]\n";
        assert!(new.ends_with(rest), "{new}");
        let again = changed(|finger| finger.motor.sign[2] = -1, &new);
        assert_eq!(again.matches(MARK).count(), 1, "{again}");
        assert!(again.contains("sign = [1, 1, -1, 1]"), "{again}");
    }

    #[test]
    fn line_ends_and_the_byte_order_mark_are_kept() {
        let text = "\u{feff}# my hand\r\n[finger.2]\r\nport = \"simulated\"\r\n";
        let new = changed(|finger| finger.motor.sign[1] = -1, text);
        assert!(new.starts_with(text) && new.matches('\n').count() == new.matches("\r\n").count(), "{new:?}");
    }

    #[test]
    fn results_with_which_no_hand_opens_are_refused() {
        let before = ConfiguredFinger::default();
        let mut after = before.clone();
        after.motor.continuous_torque = [0.1; 4];
        let [before, after] = [&before, &after].map(|finger| toml_edit::ser::to_document(finger).expect("a document"));
        let refused = with("", 2, &differences(&before, &after), &|key| key.into()).expect_err("refused").to_string();
        assert!(refused.contains("finger.2.motor.continuous_torque"), "{refused}");
    }

    #[test]
    fn each_key_has_its_own_comment() {
        let change = |finger: &mut ConfiguredFinger| {
            (finger.gauge.zero[0], finger.gauge.newton_per_count[0]) = (200.0, 0.03);
        };
        let new = changed(change, "");
        for key in ["zero", "newton_per_count"] {
            assert!(new.contains(&format!("motors: gauge.{key}\n{key} = [")), "{new}");
        }
    }

    #[test]
    fn comments_of_the_user_and_inline_tables_are_kept() {
        let text = "[finger.2.gauge]\n# from the data sheet\nzero = [1.0, 2.0, 3.0, 4.0]\n\n[finger.2.encoder]\n";
        let new = changed(|finger| finger.gauge.zero = [200.123_456_7; 4], text);
        assert!(new.contains("# from the data sheet\n# commission 2026"), "{new}");
        assert!(new.contains("zero = [200.123, 200.123, 200.123, 200.123]"), "{new}");
        let text = "[finger.2.gauge]\nzero = [ 1.0, 2.0, # upper\n  3.0, 4.0 ]   # 12 May\n";
        let new = changed(|finger| finger.gauge.zero = [5.0, 6.0, 7.0, 8.0], text);
        assert!(new.contains("zero = [ 5.0, 6.0, # upper\n  7.0, 8.0 ]   # 12 May\n"), "{new}");
        let new = changed(|finger| finger.motor.sign[0] = -1, "finger.2 = { port = \"simulated\" }\n");
        assert!(new.contains("port = \"simulated\"") && new.contains("sign = [-1, 1, 1, 1]"), "{new}");
    }
}
