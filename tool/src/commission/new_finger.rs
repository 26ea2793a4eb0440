//! Adds a further finger to a configuration file, after a search for the board of this finger.

use super::configuration_file::{LARGEST, table, with_layout_of};
use super::port_search::{Answer, Taken, search};
use crate::failure::{Failure, unwritable, wrong_usage};
use std::io::{self, Write};
use std::path::Path;
use sun2xp::files::{UpdateError, update_file, with_line_ends_of};
use sun2xp::hand::parse_configuration;
use sun2xp::model::configuration::Configuration;
use sun2xp::model::{FingerNumber, ShownPath};
use toml_edit::{Array, DocumentMut, Item, Table, Value};

/// Searches these ports, or those of `hand.search_ports`, and adds the finger with its board to the file.
pub fn add(file: &Path, hand: &Configuration, finger: FingerNumber, ports: &[String]) -> Result<(), Failure> {
    let patterns = if ports.is_empty() { &hand.hand.search_ports } else { ports };
    let others = hand.hand.fingers.members();
    let taken: Vec<Taken> =
        others.filter_map(|other| Some((hand.fingers[other.index()].board?, hand.address(other)))).collect();
    let chosen = search(patterns, hand.fingers[finger.index()].baud, finger, &taken)
        .map_err(|reason| wrong_usage(format!("{} has no finger {finger}, and {reason}", ShownPath(file))))?;
    let change = |text: &str| with(text, finger, &chosen.answer, ports).map(Some);
    update_file(file, LARGEST, change).map_err(|error| match error {
        UpdateError::File(error) => unwritable(file, &error),
        UpdateError::Change(error) => error,
    })?;
    writeln!(io::stdout(), "{} Added finger {finger} to {}.", chosen.text(), ShownPath(file))?;
    Ok(())
}

/// Returns the text with the finger.
fn with(text: &str, finger: FingerNumber, answer: &Answer, ports: &[String]) -> Result<String, Failure> {
    // Another process may have added a finger during the search.
    let configuration = parse_configuration(text)?;
    let own = (Some(answer.number()), answer.found.address);
    let mut others = configuration.hand.fingers.members().filter(|&other| other != finger);
    if others.any(|other| (configuration.fingers[other.index()].board, configuration.address(other)) == own) {
        return Err(format!("another process has added board {} meanwhile: run the tool again", answer.number()).into());
    }
    let mut document: DocumentMut = text.parse()?;
    let hand = table(document.as_table_mut(), "hand")?;
    let numbers = configuration.hand.fingers.with(finger).numbers();
    set(hand, "fingers", numbers.map(i64::from).collect::<Array>());
    let known = &configuration.hand.search_ports;
    if ports.iter().any(|port| !known.contains(port)) {
        let new = ports.iter().filter(|port| !known.contains(port));
        set(hand, "search_ports", known.iter().chain(new).map(String::as_str).collect::<Array>());
    }
    let own = table(table(document.as_table_mut(), "finger")?, &finger.to_string())?;
    own.set_implicit(false);
    set(own, "board", answer.number().to_string());
    set(own, "address", i64::from(answer.found.address));
    if let Some(counts) = answer.counts_per_revolution() {
        let encoder = table(own, "encoder")?;
        encoder.set_implicit(false);
        set(encoder, "counts_per_revolution", [i64::from(counts); 4].into_iter().collect::<Array>());
    }
    let text = with_line_ends_of(text, document.to_string());
    parse_configuration(&text).map_err(|error| format!("the finger does not fit the configuration file: {error}"))?;
    Ok(text)
}

/// Sets a key, and keeps the comments at it.
fn set(table: &mut Table, key: &str, value: impl Into<Value>) {
    let value = with_layout_of(table.get(key).and_then(Item::as_value), value.into());
    match table.get_mut(key) {
        Some(old) => *old = Item::Value(value),
        None => drop(table.insert(key, Item::Value(value))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comment_behind_a_value_is_kept() {
        let mut document: DocumentMut = "fingers = [1]  # left bench\n".parse().expect("a document");
        set(document.as_table_mut(), "fingers", [1i64, 2].into_iter().collect::<Array>());
        assert_eq!(document.to_string(), "fingers = [1, 2]  # left bench\n");
    }
}
