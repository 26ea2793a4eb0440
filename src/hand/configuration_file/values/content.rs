//! The kinds of TOML values. toml_edit has one type for what is in a table (`Item`), and another one for what is in an
//! array (`Value`). This file converts both to one type.

use crate::model::Shown;
use toml_edit::{Array, Item, TableLike, Value};

/// A value, with its kind.
pub(super) enum Content<'a> {
    Text(&'a str),
    Integer(i64),
    Float(f64),
    Boolean(bool),
    Date,
    Array(&'a Array),
    Table(&'a dyn TableLike),
    /// `[[name]]`, which no configuration contains.
    Tables,
}

impl<'a> Content<'a> {
    pub(super) fn of_item(item: &'a Item) -> Self {
        match item {
            Item::Value(value) => Self::of_value(value),
            Item::Table(table) => Self::Table(table),
            Item::ArrayOfTables(_) | Item::None => Self::Tables,
        }
    }

    pub(super) fn of_value(value: &'a Value) -> Self {
        match value {
            Value::String(text) => Self::Text(text.value()),
            Value::Integer(number) => Self::Integer(*number.value()),
            Value::Float(number) => Self::Float(*number.value()),
            Value::Boolean(flag) => Self::Boolean(*flag.value()),
            Value::Datetime(_) => Self::Date,
            Value::Array(array) => Self::Array(array),
            Value::InlineTable(table) => Self::Table(table),
        }
    }

    /// Returns the kind for use in an error text. For a string, the text includes its contents.
    pub(super) fn kind(&self) -> String {
        let kind = match self {
            Self::Text(text) => return format!("the text \"{}\"", Shown(text)),
            Self::Integer(_) => "a whole number",
            Self::Float(_) => "a number with a decimal point or exponent",
            Self::Boolean(_) => "true or false",
            Self::Date => "a date",
            Self::Array(_) => "an array",
            Self::Table(_) => "a table",
            Self::Tables => "an array of tables",
        };
        kind.into()
    }
}
