//! Changes single values in a TOML document, and keeps everything around these values.

use crate::hand::found::{Numbers, rounded, with_signs};
use toml_edit::{Array, Item, Table, TableLike, Value};

/// The values to write, and whether they form an array. `present` contains the numbers that the key has in the file, or
/// its default values.
pub(super) fn written(numbers: &Numbers, present: &[f64]) -> (Vec<Value>, bool) {
    match numbers {
        Numbers::Whole(values) => (values.iter().map(|&value| value.into()).collect(), true),
        Numbers::Real(values) => (values.iter().map(|&value| rounded(value)).collect(), true),
        Numbers::Rows(rows) => {
            let row = |values: &Vec<f64>| Value::Array(values.iter().map(|&value| rounded(value)).collect());
            (rows.iter().map(row).collect(), true)
        }
        Numbers::One(value) => (vec![rounded(*value)], false),
        Numbers::SignsOf(signs) => (with_signs(present, *signs).into_iter().map(Value::from).collect(), true),
    }
}

/// Writes values to a key in the table `section`. `present` contains the numbers that the key has now, in this table,
/// in the table for all fingers or by default. If the key is in this table, its comments and layout are kept. An array
/// of another shape is written anew, without the comments in it.
pub(super) fn set(section: &mut dyn TableLike, key: &str, values: Vec<Value>, array: bool, present: &[f64]) {
    if array {
        match section.get_mut(key).and_then(Item::as_array_mut) {
            Some(here) if has_shape_of(here, &values) => fill(here, values, &mut present.iter()),
            Some(here) => {
                let mut array = values.into_iter().collect::<Array>();
                // A comment after the array stays.
                *array.decor_mut() = here.decor().clone();
                *here = array;
            }
            None => {
                section.insert(key, Item::Value(Value::Array(values.into_iter().collect())));
            }
        }
        return;
    }
    for mut value in values {
        match section.get_mut(key).and_then(Item::as_value_mut) {
            Some(here) => {
                *value.decor_mut() = here.decor().clone();
                *here = value;
            }
            None => {
                section.insert(key, Item::Value(value));
            }
        }
    }
}

/// Whether the array has as many numbers as `values`, or as many rows with as many numbers.
fn has_shape_of(array: &Array, values: &[Value]) -> bool {
    array.len() == values.len()
        && array.iter().zip(values).all(|(here, value)| match (here, value) {
            (Value::Array(here), Value::Array(row)) => here.len() == row.len(),
            (here, value) => !here.is_array() && !value.is_array(),
        })
}

/// Replaces the numbers of an array that has the shape of `values`. A number in the array stays as it is written if the
/// new number equals the corresponding number in `present`.
fn fill<'a>(array: &mut Array, values: Vec<Value>, present: &mut impl Iterator<Item = &'a f64>) {
    for (place, value) in values.into_iter().enumerate() {
        match (array.get_mut(place), value) {
            (Some(Value::Array(here)), Value::Array(row)) => fill(here, row.into_iter().collect(), present),
            (_, value) => {
                if present.next().is_none_or(|&number| !is(&value, number)) {
                    array.replace(place, value);
                }
            }
        }
    }
}

/// Whether the values are present already.
pub(super) fn same(values: &[Value], present: &[f64]) -> bool {
    let values: Vec<&Value> = values.iter().flat_map(flat).collect();
    values.len() == present.len() && values.into_iter().zip(present).all(|(value, &number)| is(value, number))
}

/// Returns the numbers of a value, row by row.
fn flat(value: &Value) -> Vec<&Value> {
    match value {
        Value::Array(row) => row.iter().collect(),
        number => vec![number],
    }
}

/// Whether a value equals this number, or equals this number rounded to the digits that are stored.
fn is(value: &Value, number: f64) -> bool {
    match value {
        Value::Integer(whole) => *whole.value() as f64 == number,
        value => value.as_float() == Some(number) || value.as_float() == rounded(number).as_float(),
    }
}

/// Returns the table with this key. If there is none, inserts an empty table, whose header is written only when the
/// table has keys.
pub(super) fn child<'a>(parent: &'a mut dyn TableLike, key: &str) -> Result<&'a mut dyn TableLike, String> {
    if !parent.contains_key(key) {
        let mut table = Table::new();
        table.set_implicit(true);
        parent.insert(key, Item::Table(table));
    }
    let table = parent.get_mut(key).and_then(Item::as_table_like_mut);
    table.ok_or_else(|| format!("`{key}` is not a table"))
}
