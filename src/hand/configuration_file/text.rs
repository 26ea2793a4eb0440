//! Conversion of the text of a configuration file to a [`Configuration`], or to an error with line and reason.

use super::named_hand::add_named_values;
use super::values::deserialize;
use super::wrong::Wrong;
use crate::hand::opening::check;
use crate::model::configuration::{Configuration, ConfiguredFinger, ConfiguredHand, FINGERS};
use crate::model::{FingerNumber, Section, Shown, UnusableConfiguration};
use std::ops::Range;
use toml_edit::{Document, Item, Table, Value};

/// The tables that a configuration file may have. Other programs read the tables `serve` and `remote`.
const TABLES: [&str; 5] = ["hand", "telemetry", "finger", "serve", "remote"];

/// What the text says, apart from the values.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Said {
    /// For each finger, whether the text names its port.
    pub ports: [bool; FINGERS],
    /// Whether the text has the table `remote`.
    pub remote: bool,
}

/// Reads and checks the text of a configuration file.
pub(super) fn parse(text: &str) -> Result<(Configuration, Said), Wrong> {
    let document = Document::parse(text).map_err(Wrong::in_syntax)?;
    let root = document.as_table();
    if let Some((key, _)) = root.iter().find(|(key, _)| !TABLES.contains(key)) {
        let reason = format!("unknown key `{}`, expected `{}`", Shown(key), TABLES.join("`, `"));
        return Err(Wrong::at(span_of_key(root, key), reason));
    }
    let hand: ConfiguredHand = deserialize(&table(root, "hand")?).map_err(|wrong| wrong.in_key("hand"))?;
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
    let mut fingers: [ConfiguredFinger; FINGERS] = Default::default();
    let mut ports = [false; FINGERS];
    for ((number, finger), port_named) in numbers().zip(&mut fingers).zip(&mut ports) {
        let section = format!("finger.{number}");
        let own = table(&all, &number).map_err(|wrong| wrong.in_key("finger"))?;
        (*finger, *port_named) = finger_of(&common, &own).map_err(|wrong| wrong.in_key(&section))?;
    }

    let configuration = Configuration { hand, telemetry, fingers };
    check(&configuration).map_err(|refusal| unusable(root, &refusal))?;
    refuse_simulated_beside_real(root, &configuration, ports)?;
    Ok((configuration, Said { ports, remote: root.contains_key("remote") }))
}

/// Reads a finger from the table of all fingers and its own table. Also returns whether they name its port or its
/// board.
fn finger_of(common: &Table, own: &Table) -> Result<(ConfiguredFinger, bool), Wrong> {
    let mut merged = common.clone();
    // Both keys say where a finger is. If the finger's own table has one of them, the other one of the common table is
    // not used.
    for (key, other) in [("board", "port"), ("port", "board")] {
        if own.contains_key(key) && !own.contains_key(other) {
            merged.remove(other);
        }
    }
    overlay(&mut merged, own);
    let (port, board) = (merged.contains_key("port"), merged.contains_key("board"));
    if port && board {
        let reason = "the table has `port` too, and the board is at one port only: keep one of the two keys";
        return Err(Wrong::at(span_of_key(&merged, "board"), reason.into()).in_key("board"));
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
    let real = named.iter().find(|number| !configuration.fingers[number.index()].simulated());
    let (Some(real), Some(missing)) = (real, unnamed.first()) else { return Ok(()) };
    let own = root.get("finger").and_then(|all| all.get(real.to_string()));
    let span = span_of(own, "port").or_else(|| span_of(own, "board"));
    let fingers: Vec<String> = named.iter().map(FingerNumber::to_string).collect();
    let reason = format!(
        "is missing, and finger {real} has a real port: a finger is not simulated beside real ones unless the file \
         says so. If the hand does not have finger {missing}, set hand.fingers = [{}]. Otherwise name its port or its \
         board, or set port = \"simulated\" in [finger.{missing}]",
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

/// Merges `over` into `base`, table by table. Keys that `over` does not contain keep their values.
pub(in crate::hand) fn overlay(base: &mut Table, over: &Table) {
    for (key, item) in over.iter() {
        let both = (table(base, key), table(over, key));
        let merged = match both {
            (Ok(mut below), Ok(above)) if base.contains_key(key) => {
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

/// The position of a dotted key in the file, if the file contains it.
fn span_of(section: Option<&Item>, dotted: &str) -> Option<Range<usize>> {
    let (path, last) = dotted.rsplit_once('.').unwrap_or(("", dotted));
    let parent = path.split('.').filter(|part| !part.is_empty()).try_fold(section?, |item, part| item.get(part))?;
    parent.as_table_like()?.key(last)?.span()
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

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(text: &str) -> (Option<usize>, String) {
        let wrong = parse(text).expect_err("refused");
        (wrong.line(text), wrong.to_string())
    }

    #[test]
    fn an_empty_file_is_the_default_hand() {
        assert_eq!(parse("").expect("usable").0, Configuration::default());
    }

    #[test]
    fn a_finger_overrides_what_all_fingers_share() {
        let text = "[finger]\nport = 'simulated'\nbaud = 2000000\n[finger.tendon]\nminimum = 4\nmaximum = 50\n\
                    [finger.2]\nport = '/dev/ttyUSB1'\n[finger.2.tendon]\nminimum = 6\n";
        let (hand, _) = parse(text).expect("usable");
        assert_eq!(hand.fingers.each_ref().map(|f| f.baud), [2_000_000; 3]);
        assert_eq!(hand.fingers.each_ref().map(|f| f.tendon.minimum), [4.0, 6.0, 4.0]);
        assert_eq!(hand.fingers.each_ref().map(|f| f.tendon.maximum), [50.0; 3]);
        assert_eq!(hand.fingers[1].port, "/dev/ttyUSB1");
        assert_eq!(hand.fingers[0].port, "simulated");
    }

    #[test]
    fn unknown_keys_are_named_with_their_line() {
        for (text, line, word) in [
            ("[hand]\nrate = 1000\nrat = 5\n", 3, "rat"),
            ("[finger]\n[finger.gauge]\nzeros = [0, 0, 0, 0]\n", 3, "zeros"),
            ("[finger.3]\n\nbord = 1\n", 3, "bord"),
            ("[fingers]\n", 1, "fingers"),
            ("[finger.4]\n", 1, "4"),
        ] {
            let (found, reason) = refusal(text);
            assert_eq!(found, Some(line), "{text:?}: {reason}");
            assert!(reason.contains(word), "{text:?}: {reason}");
        }
    }

    #[test]
    fn a_finger_without_a_port_is_not_simulated_beside_real_ones() {
        let text = "[finger.2]\nport = '/dev/a'\n[finger.3]\nboard = '00 01 02 03 04 05 06 07 08 09 0a 0b'\n";
        let (line, reason) = refusal(text);
        assert_eq!(line, Some(2), "{reason}");
        assert!(
            reason.starts_with("finger.1.port: is missing") && reason.contains("hand.fingers = [2, 3]"),
            "{reason}"
        );
        for beside in ["[finger.1]\nport = 'simulated'\n", "[hand]\nfingers = [2, 3]\n"] {
            let (hand, _) = parse(&format!("{text}{beside}")).expect("usable");
            assert!(hand.fingers[2].board.is_some() && !hand.fingers[2].simulated(), "{beside}");
        }
    }

    #[test]
    fn a_port_of_a_finger_replaces_the_board_of_all_and_the_reverse() {
        let board = "board = '00 01 02 03 04 05 06 07 08 09 0a 0b'\n";
        let (hand, _) = parse(&format!("[finger]\nport = 'simulated'\n[finger.1]\n{board}")).expect("usable");
        assert_eq!(hand.fingers.each_ref().map(ConfiguredFinger::simulated), [false, true, true]);
        let of_all = format!("[finger]\nthread = 1\nbaud = 2000000\n{board}");
        let (hand, _) = parse(&format!("{of_all}[finger.2]\nport = 'simulated'\n")).expect("usable");
        assert_eq!(hand.fingers.each_ref().map(ConfiguredFinger::simulated), [false, true, false]);
        let (line, reason) = refusal(&format!("[finger.1]\nport = '/dev/a'\n{board}"));
        assert!(line == Some(3) && reason.contains("keep one of the two keys"), "{reason}");
    }

    #[test]
    fn a_hand_has_the_listed_fingers() {
        let (hand, _) = parse("[hand]\nfingers = [3, 1]\n[finger.2]\nport = '/dev/later'\n").expect("usable");
        assert_eq!(hand.hand.fingers.numbers().collect::<Vec<_>>(), [1, 3]);
        for (list, word) in [("[]", "at least one"), ("[4]", "no finger 4"), ("[2, 2]", "twice"), ("2", "must be")] {
            let (line, reason) = refusal(&format!("[hand]\nfingers = {list}\n"));
            assert!(line == Some(2) && reason.contains(word), "{list}: {reason}");
        }
    }

    #[test]
    fn wrong_types_are_named_with_their_line() {
        for (text, line) in [
            ("[hand]\n\nrate = 'fast'\n", 3),
            ("[finger.tendon]\nstiffness = [1, 2, 3]\n", 2),
            ("hand = 3\n", 1),
            ("[finger]\n2 = 7\n", 2),
            ("[hand]\nrate = \n", 2),
        ] {
            let (found, reason) = refusal(text);
            assert_eq!(found, Some(line), "{text:?}: {reason}");
        }
    }

    #[test]
    fn impossible_values_are_named_with_line_and_reason() {
        let printed =
            "[finger.geometry]\nr = [[-1.09, 0.62, 0.62, -1.09], [1.09, 0.62, -0.62, 1.09], [0, 0.62, -0.62, 0]]\n";
        let with_ones = &format!("{printed}ghost_row = [1, 1, 1, 1]\n");
        for (text, line, words) in [
            (printed, Some(2), "positive"),
            (with_ones, Some(2), "singular"),
            ("[finger.geometry]\nr = [[1, 1, 1, 1], [1, 0, 0, 0], [2, 1, 1, 1]]\n", Some(2), "singular"),
            ("[finger.1.geometry]\nghost_row = [-1, -1, -1, -1]\n", Some(2), "positive"),
            ("[finger.geometry]\nr = [[1, 1, 1, 1], [1, 0, 0, 0], [0, 1, 0, 0]]\n", Some(2), "positive"),
            ("[finger.3.tendon]\nmaximum = 8\n", Some(2), "for its pretension"),
            // The refused key, tendon.maximum, is not in the file, so the error gives the line of its table. Another
            // key of that table makes the default value of tendon.maximum unusable.
            ("[finger.tendon]\n\nminimum = 40\n", Some(1), "for its pretension"),
            ("[hand]\nrate = 500\n\n[finger.3.tendon]\nminimum = 40\n", Some(4), "for its pretension"),
            ("[hand]\nrate = nan\n", Some(2), "outside"),
            ("[hand]\nwatchdog_ms = 3\nrate = 500\n", Some(2), "two periods"),
            ("[finger.2.joints]\nminimum_degrees = [0, 0, -5]\n", Some(2), "singular"),
            ("[finger]\nport = '/dev/ttyUSB0'\naddress = 1\n", Some(1), "thread"),
        ] {
            let (found, reason) = refusal(text);
            assert_eq!(found, line, "{text:?}: {reason}");
            assert!(reason.contains(words), "{text:?}: {reason}");
        }
    }
}
