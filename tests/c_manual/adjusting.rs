//! sun2xp_adjust must refuse to change exactly the keys that its entry in the manual lists.

use super::c::root;
use super::manual::{HANDLES, Manual, in_one_line, listed};
use std::fs;
use sun2xp::hand::Hand;
use sun2xp::model::configuration::Configuration;

/// Every key of a finger in docs/sun2xp.toml, with its value there. Optional keys and tables stand behind a number
/// sign.
fn keys_of_a_finger() -> Vec<String> {
    let page = fs::read_to_string(root().join("docs/sun2xp.toml")).expect("the page");
    let mut table = None;
    let mut keys = Vec::new();
    for line in page.lines().map(|line| line.strip_prefix('#').unwrap_or(line)) {
        if let Some(name) = line.strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
            // The tables of one finger have the same keys as those of all fingers.
            let below = |name: &str| {
                name.trim_start_matches(|letter: char| letter == '.' || letter.is_ascii_digit()).to_string()
            };
            table = name.strip_prefix("finger").map(below);
        } else if let Some(table) = &table
            && line.starts_with(|first: char| first.is_ascii_lowercase())
            && line.contains(" = ")
        {
            let dot = if table.is_empty() { "" } else { "." };
            keys.push(format!("{table}{dot}{line}"));
        }
    }
    keys
}

#[test]
fn the_keys_that_cannot_change_are_named() {
    let manual = Manual::read(HANDLES);
    let entry = manual.entries.iter().find(|entry| entry.call == "sun2xp_adjust").expect("the entry");
    let text = in_one_line(&entry.text);
    let (_, rest) = text.split_once("cannot change while the hand is open: ").expect("a sentence that names them");
    let named = listed(rest.split_once(". ").expect("the sentence ends").0);
    let hand = Hand::open(Configuration::default()).expect("the simulated hand");
    let keys = keys_of_a_finger();
    assert!(keys.len() > 30, "{keys:?}");
    let covers = |named: &str, key: &str| key.strip_prefix(named).is_some_and(|rest| rest.starts_with([' ', '.']));
    for key in &keys {
        let refused = hand.adjust(1, key).is_err_and(|error| error.errno() == libc::EBUSY);
        assert_eq!(refused, named.iter().any(|named| covers(named, key)), "{key}: {named:?}");
    }
    for named in named {
        assert!(keys.iter().any(|key| covers(named, key)), "{named} is no key of a finger");
    }
}
