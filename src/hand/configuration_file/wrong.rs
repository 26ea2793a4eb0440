//! Errors in a configuration, with their positions.

use crate::model::{Shown, one_line};
use serde::de::{Error, Expected, Unexpected};
use std::fmt::{self, Display, Formatter};
use std::ops::Range;
use toml_edit::TomlError;

/// Text that is not valid TOML, an unknown key, or an invalid value. The details are boxed, because serde's code for
/// each type moves the error at many places.
#[derive(Debug)]
pub struct Wrong(Box<Details>);

#[derive(Debug)]
struct Details {
    /// Dotted path of the key, as far as it is known.
    path: String,
    /// Position in the text.
    span: Option<Range<usize>>,
    /// What is wrong, without the path.
    reason: String,
}

impl Wrong {
    /// An error with this reason at this position.
    #[cold]
    #[inline(never)]
    pub fn at(span: Option<Range<usize>>, reason: String) -> Self {
        Self(Box::new(Details { path: String::new(), span, reason }))
    }

    /// A syntax error. The parser's messages contain no part of the text, so they need no `Shown`.
    pub fn in_syntax(error: TomlError) -> Self {
        match error.span() {
            None => Self::at(None, "a key has 80 parts or more, which no key of a configuration has".into()),
            span => Self::at(span, error.message().into()),
        }
    }

    /// The same error at this position, unless its position is known already.
    #[inline(never)]
    pub fn or_at(mut self, span: Option<Range<usize>>) -> Self {
        self.0.span = self.0.span.take().or(span);
        self
    }

    /// The same error inside this key.
    #[inline(never)]
    pub fn in_key(mut self, key: &str) -> Self {
        let path = &mut self.0.path;
        let point = if path.is_empty() || path.starts_with('[') { "" } else { "." };
        *path = format!("{key}{point}{path}");
        self
    }

    /// The same error inside this entry of an array, counted from 0.
    #[inline(never)]
    pub fn in_entry(self, index: usize) -> Self {
        self.in_key(&format!("[{index}]"))
    }

    /// The line of `text` with the error, counted from 1.
    pub fn line(&self, text: &str) -> Option<usize> {
        let before = text.get(..self.0.span.as_ref()?.start)?;
        Some(before.matches('\n').count() + 1)
    }
}

impl Display for Wrong {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        let Details { path, reason, .. } = &*self.0;
        let colon = if path.is_empty() { "" } else { ": " };
        write!(formatter, "{path}{colon}{reason}")
    }
}

impl std::error::Error for Wrong {}

impl Error for Wrong {
    /// Called with the library's own texts. They quote nothing of the file, and their ends contain the remedy, so they
    /// are not shortened.
    #[inline(never)]
    fn custom<T: Display>(reason: T) -> Self {
        Self::at(None, one_line(&reason.to_string()))
    }

    /// Unlike serde's own text, this one does not quote the value.
    fn invalid_value(_: Unexpected, expected: &dyn Expected) -> Self {
        Self::at(None, format!("must be {expected}"))
    }

    fn invalid_type(_: Unexpected, expected: &dyn Expected) -> Self {
        Self::at(None, format!("must be {expected}"))
    }

    #[inline(never)]
    fn unknown_variant(variant: &str, expected: &'static [&'static str]) -> Self {
        Self::at(None, format!("must be {}, not \"{}\"", one_of(expected), Shown(variant)))
    }

    #[inline(never)]
    fn unknown_field(field: &str, expected: &'static [&'static str]) -> Self {
        Self::at(None, format!("unknown key `{}`, expected {}", Shown(field), one_of(expected)))
    }

    #[inline(never)]
    fn missing_field(field: &'static str) -> Self {
        Self::at(None, format!("`{field}` is missing"))
    }

    #[inline(never)]
    fn duplicate_field(field: &'static str) -> Self {
        Self::at(None, format!("duplicate field `{field}`"))
    }
}

/// Formats the names to choose from.
pub fn one_of(names: &[&str]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match names.len() {
        0..3 => names.join(" or "),
        _ => format!("one of {}", names.join(", ")),
    }
}
