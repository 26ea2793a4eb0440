//! The manual page of the configuration file, made from docs/sun2xp.toml.

use super::Page;
use super::body::{body, section};
use clap_mangen::roff::{Roff, bold, roman};

/// Returns the page.
pub fn page(file: &str) -> Page {
    let mut text = Roff::new();
    text.control("SH", ["NAME"]);
    text.text([roman("sun2xp.toml - configuration of a hand")]);
    let mut comment: Vec<&str> = Vec::new();
    let mut tables = false;
    for line in file.lines() {
        let trimmed = line.trim();
        if let Some((key, value)) = key(line) {
            text.control("TP", []);
            text.text([bold(key), roman(" = "), roman(value)]);
            body_of_key(&mut text, &std::mem::take(&mut comment));
        } else if let Some(table) = table(trimmed) {
            if !tables {
                section(&mut text, "DESCRIPTION", &std::mem::take(&mut comment));
                tables = true;
            }
            text.control("SH", [table]);
            body(&mut text, &std::mem::take(&mut comment));
        } else if let Some(line) = trimmed.strip_prefix('#') {
            comment.push(line.strip_prefix(' ').unwrap_or(line));
        } else if tables {
            // A comment before an empty line is not about one key, but about all keys that follow.
            body(&mut text, &std::mem::take(&mut comment));
        }
    }
    text.control("SH", ["SEE ALSO"]);
    text.text([roman("sun2xp(1), Sun2Xp(3)")]);
    Page { name: "sun2xp.toml".into(), section: 5, text }
}

fn body_of_key(text: &mut Roff, comment: &[&str]) {
    for (index, paragraph) in comment.split(|line| line.is_empty()).enumerate() {
        if index > 0 {
            text.control("IP", []);
        }
        text.text([roman(paragraph.join("\n"))]);
    }
}

/// Returns the table of a line such as `[hand]`. A line with an optional table begins with # and has no space after it.
fn table(line: &str) -> Option<&str> {
    let table = line.strip_prefix('#').unwrap_or(line);
    (table.starts_with('[') && table.ends_with(']')).then_some(table)
}

/// Returns the key and the value of a line such as `rate = 1000.0`. A line with an optional key begins with # and has
/// no space after it.
pub fn key(line: &str) -> Option<(&str, &str)> {
    let line = line.strip_prefix('#').unwrap_or(line);
    let (key, value) = line.split_once(" = ")?;
    let plain = key.chars().all(|letter| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_');
    (plain && !key.is_empty()).then_some((key, value))
}
