//! Conversion of the text of a configuration file to a [`Configuration`], or to an error with line and reason.

#[cfg(test)]
mod tests;

use super::named_hand::{add_named_values, set_name};
use super::values::deserialize;
use super::wrong::Wrong;
use crate::hand::opening::check;
use crate::model::configuration::{Configuration, ConfiguredFinger, ConfiguredHand, FINGERS};
use crate::model::{FingerNumber, Section, Shown, UnusableConfiguration};
use std::ops::Range;
use toml_edit::{Document, Item, Table, Value, value};

/// The tables that a configuration file may have. `sun2xp-serve` reads the table `serve`, and
/// `libsun2xp_remote` the table `remote`.
const TABLES: [&str; 5] = ["hand", "telemetry", "finger", "serve", "remote"];

/// Keys in the table of a finger. The value of each is a table with a single key, which selects a variant.
const CHOICES: [&str; 1] = ["surface"];

/// What the text says, apart from the values.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Said {
    /// For each finger, whether the text names its port or board, or `parse_with` has replaced its port.
    pub ports: [bool; FINGERS],
    /// Whether the text has the table `remote`.
    pub remote: bool,
}

/// Reads and checks the text of a configuration file.
#[cfg(test)]
pub(super) fn parse(text: &str) -> Result<(Configuration, Said), Wrong> {
    parse_with(text, None, &|_, _| false)
}

/// Reads and checks the text of a configuration file. `named` has a name and a rate, Hz. The name replaces
/// `simulation.hand` of every finger, and the rate replaces `hand.rate`, before anything is checked. `replace_port` can
/// replace the port of a finger before the ports are checked, and returns whether it did.
pub(super) fn parse_with(
    text: &str,
    named: Option<(&str, f64)>,
    replace_port: &dyn Fn(FingerNumber, &mut ConfiguredFinger) -> bool,
) -> Result<(Configuration, Said), Wrong> {
    let document = Document::parse(text).map_err(Wrong::in_syntax)?;
    let root = document.as_table();
    if let Some((key, _)) = root.iter().find(|(key, _)| !TABLES.contains(key)) {
        let reason = format!("unknown key `{}`, expected `{}`", Shown(key), TABLES.join("`, `"));
        return Err(Wrong::at(span_of_key(root, key), reason));
    }
    let mut of_hand = table(root, "hand")?;
    if let Some((_, rate)) = named {
        of_hand.insert("rate", value(rate));
    }
    let hand: ConfiguredHand = deserialize(&of_hand).map_err(|wrong| wrong.in_key("hand"))?;
    let telemetry = deserialize(&table(root, "telemetry")?).map_err(|wrong| wrong.in_key("telemetry"))?;
    let all = table(root, "finger")?;
    let numbers = || (1..=FINGERS).map(|number| number.to_string());
    if let Some((key, _)) = all.iter().find(|(key, _)| is_number(key) && !numbers().any(|number| number == *key)) {
        let reason = format!("there is no finger {}: fingers are 1, 2 and 3", Shown(key));
        return Err(Wrong::at(span_of_key(&all, key), reason));
    }
    let mut common = all.clone();
    for number in numbers() {
        common.remove(&number);
    }
    let name = named.map(|(name, _)| name);
    let mut fingers: [ConfiguredFinger; FINGERS] = Default::default();
    let mut ports = [false; FINGERS];
    for ((number, finger), port_named) in FingerNumber::ALL.into_iter().zip(&mut fingers).zip(&mut ports) {
        let section = format!("finger.{number}");
        let own = table(&all, &number.to_string()).map_err(|wrong| wrong.in_key("finger"))?;
        (*finger, *port_named) = finger_of(&common, &own, name).map_err(|wrong| wrong.in_key(&section))?;
        *port_named |= replace_port(number, finger);
    }

    let configuration = Configuration { hand, telemetry, fingers };
    check(&configuration).map_err(|refusal| unusable(root, &refusal))?;
    refuse_simulated_beside_real(root, &configuration, ports)?;
    Ok((configuration, Said { ports, remote: root.contains_key("remote") }))
}

/// Reads a finger from the table of all fingers and its own table. Also returns whether they name its port or its
/// board.
fn finger_of(common: &Table, own: &Table, name: Option<&str>) -> Result<(ConfiguredFinger, bool), Wrong> {
    let mut merged = common.clone();
    // Both keys say where a finger is. If the finger's own table has only one of them, the other key is not taken from
    // the common table.
    for (key, other) in [("board", "port"), ("port", "board")] {
        if own.contains_key(key) && !own.contains_key(other) {
            merged.remove(other);
        }
    }
    overlay(&mut merged, own);
    let (port, board) = (merged.contains_key("port"), merged.contains_key("board"));
    if port && board {
        let reason = "the table has `port` too, and each of the two keys says where the board is: remove one of them";
        return Err(Wrong::at(span_of_key(&merged, "board"), reason.into()).in_key("board"));
    }
    if let Some(name) = name {
        set_name(&mut merged, name);
    }
    add_named_values(&mut merged)?;
    Ok((deserialize(&merged)?, port || board))
}

/// Refuses a hand if the file names a real port or board for some fingers, but no port and no board for others. The
/// others would be simulated beside real ones, although the file does not say so.
fn refuse_simulated_beside_real(
    root: &Table,
    configuration: &Configuration,
    ports_named: [bool; FINGERS],
) -> Result<(), Wrong> {
    let (named, unnamed): (Vec<_>, Vec<_>) =
        configuration.hand.fingers.members().partition(|number| ports_named[number.index()]);
    let at_port = |finger: &ConfiguredFinger| !finger.simulated() && !finger.has_io();
    let real = named.iter().find(|number| at_port(&configuration.fingers[number.index()]));
    let (Some(real), Some(missing)) = (real, unnamed.first()) else { return Ok(()) };
    let own = root.get("finger").and_then(|all| all.get(real.to_string()));
    let span = span_of(own, "port").or_else(|| span_of(own, "board"));
    let fingers: Vec<String> = named.iter().map(FingerNumber::to_string).collect();
    let reason = format!(
        "is missing, and finger {real} has a real port: a finger is not simulated beside real ones unless the file \
         says so. If the file names the ports of all fingers of the hand, set hand.fingers = [{}]. Otherwise name the \
         port or the board of finger {missing}, or set port = \"simulated\" in [finger.{missing}]",
        fingers.join(", ")
    );
    Err(Wrong::at(span, reason).in_key("port").in_key(&format!("finger.{missing}")))
}

/// An error for a value that the checks refuse, with its position in the file.
fn unusable(root: &Table, refusal: &UnusableConfiguration) -> Wrong {
    let key = refusal.unusable.key;
    let section = refusal.section.to_string();
    let places = match refusal.section {
        Section::Hand | Section::Telemetry => [root.get(&section), None],
        Section::Finger(number) => {
            let shared = root.get("finger");
            [shared.and_then(|all| all.get(number.to_string())), shared]
        }
    };
    let span = places.iter().find_map(|&place| span_of(place, key));
    let near = || places.iter().find_map(|&place| nearest_table(place, key));
    Wrong::at(span.or_else(near), refusal.unusable.reason.clone()).in_key(key).in_key(&section)
}

fn is_number(key: &str) -> bool {
    let digits = key.trim_start_matches('-');
    !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())
}

fn span_of_key(table: &Table, key: &str) -> Option<Range<usize>> {
    table.key(key)?.span()
}

/// The table with this key; an empty one if there is no such key. An inline table is a table too.
fn table(parent: &Table, key: &str) -> Result<Table, Wrong> {
    match parent.get(key).cloned() {
        None => Ok(Table::new()),
        Some(Item::Table(table)) => Ok(table),
        Some(Item::Value(Value::InlineTable(table))) => Ok(table.into_table()),
        Some(other) => Err(Wrong::at(other.span(), "must be a table".into()).in_key(key)),
    }
}

/// Merges `over` into `base`, table by table. Keys that `over` does not contain keep their values, except in a table
/// whose only key is a choice: another choice replaces the table.
pub(in crate::hand) fn overlay(base: &mut Table, over: &Table) {
    for (key, item) in over.iter() {
        let both = (table(base, key), table(over, key));
        let merged = match both {
            (Ok(mut below), Ok(above)) if base.contains_key(key) && !is_other_choice(key, &below, &above) => {
                overlay(&mut below, &above);
                Item::Table(below)
            }
            _ => item.clone(),
        };
        // The key object is copied too, because it holds the key's position.
        match over.key(key).cloned() {
            Some(named) => {
                base.remove(key);
                base.insert_formatted(&named, merged);
            }
            None => {
                base.insert(key, merged);
            }
        }
    }
}

/// Whether the tables of this key choose differently.
fn is_other_choice(key: &str, below: &Table, above: &Table) -> bool {
    CHOICES.contains(&key) && !above.is_empty() && !above.iter().any(|(choice, _)| below.contains_key(choice))
}

/// The position of a dotted key in the file, if the file contains it.
fn span_of(section: Option<&Item>, dotted: &str) -> Option<Range<usize>> {
    let (path, last) = dotted.rsplit_once('.').unwrap_or(("", dotted));
    let parent = path.split('.').filter(|part| !part.is_empty()).try_fold(section?, |item, part| item.get(part))?;
    parent.as_table_like()?.key(last)?.span()
}

/// The number of the line of a dotted key in a TOML text; the first line is 1. None if the text does not contain the
/// key.
pub(in crate::hand) fn line_of_key(text: &str, dotted: &str) -> Option<usize> {
    let keys = Document::parse(text).ok()?;
    Wrong::at(span_of(Some(keys.as_item()), dotted), String::new()).line(text)
}

/// The position of the innermost table of a dotted key. It is used for a key that the file does not contain, and whose
/// default value conflicts with another value in the file. That other value is usually in the same table.
fn nearest_table(section: Option<&Item>, dotted: &str) -> Option<Range<usize>> {
    let (path, _) = dotted.rsplit_once('.').unwrap_or(("", dotted));
    let mut item = section?;
    let mut span = item.span();
    for part in path.split('.').filter(|part| !part.is_empty()) {
        let Some(inner) = item.get(part) else { break };
        item = inner;
        span = item.span().or(span);
    }
    span
}
