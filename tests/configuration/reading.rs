//! Reads configurations, and the reference configuration docs/sun2xp.toml, which contains every key.

use std::fs;
use sun2xp::hand::{self, ConfigurationError};
use sun2xp::model::configuration::Configuration;

pub const REFERENCE: &str = include_str!("../../docs/sun2xp.toml");

pub fn read(text: &str) -> Result<Configuration, (Option<usize>, String)> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("sun2xp.toml");
    fs::write(&file, text).expect("written");
    hand::read_configuration(&file).map_err(|error| match error {
        ConfigurationError::Invalid { line, reason, .. } => (line, reason),
        other => panic!("{other}"),
    })
}

pub fn usable(text: &str) -> Configuration {
    read(text).unwrap_or_else(|(line, reason)| panic!("line {line:?}: {reason}\n{text}"))
}

/// Returns the reference with its optional keys enabled. The reference disables a key with a # that no space follows.
pub fn with_optional_keys() -> String {
    let shown = |line: &'static str| match line.strip_prefix('#') {
        Some(key) if key.starts_with(|first: char| first.is_ascii_lowercase() || first == '[') => key,
        _ => line,
    };
    REFERENCE.lines().map(|line| shown(line).to_owned() + "\n").collect()
}

/// A key with its table, its value, its line number (from 1), and the comment above it.
#[derive(Debug)]
pub struct Key {
    pub table: String,
    pub name: String,
    pub value: String,
    pub line: usize,
    pub comment: String,
}

pub fn keys(text: &str) -> Vec<Key> {
    let (mut keys, mut table, mut comment) = (Vec::new(), String::new(), String::new());
    for (index, line) in text.lines().enumerate() {
        if let Some(words) = line.strip_prefix('#') {
            comment += words;
        } else if let Some(name) = line.strip_prefix('[') {
            table = name.trim_end_matches(']').into();
        } else if let Some((name, value)) = line.split_once(" = ") {
            let (name, value) = (name.to_owned(), value.to_owned());
            keys.push(Key { table: table.clone(), name, value, line: index + 1, comment: comment.clone() });
        } else {
            comment.clear();
        }
    }
    keys
}

/// `value` with each of its numbers replaced.
pub fn with_numbers(value: &str, number: &str) -> String {
    let part_of_a_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | 'e' | '+');
    let mut replaced = String::new();
    let mut rest = value;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit() || c == '-') {
        replaced += &rest[..start];
        replaced += number;
        rest = rest[start..].trim_start_matches(part_of_a_number);
    }
    replaced + rest
}
