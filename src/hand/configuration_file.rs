//! Finds the configuration file and turns it into a [`Configuration`], naming file, line and reason where it cannot.

use crate::files::read_regular_file;
use crate::hand::HandError;
use crate::hand::opening::check;
use crate::model::configuration::{Configuration, ConfiguredFinger, ConfiguredHand, FINGERS};
use etcetera::BaseStrategy;
use serde::de::{DeserializeOwned, IntoDeserializer};
use std::env;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml_edit::{Document, Item, Table, Value};

/// The largest configuration file that is read, bytes: more than sixty times docs/sun2xp.toml, which names every key.
const LARGEST: u64 = 1 << 20;

/// The file that `SUN2XP_CONFIG` names, else `sun2xp.toml` in the working directory, else `sun2xp/sun2xp.toml` in the
/// user's configuration folder, else in the system's (`XDG_CONFIG_DIRS`, or `/etc/xdg`); none of them: no path, and the
/// simulated hand. An empty `SUN2XP_CONFIG` counts as unset.
///
/// # Errors
/// A file that is named or found and cannot be read or used. A missing file that `SUN2XP_CONFIG` names is an error too:
/// a planner that believes it moves a real hand must never get the simulation instead.
pub fn configured() -> Result<(Configuration, Option<PathBuf>), HandError> {
    match locate() {
        Some(path) => read(&path).map(|configuration| (configuration, Some(path))),
        None => Ok((Configuration::default(), None)),
    }
}

/// Reads and checks one configuration file.
///
/// # Errors
/// [`HandError::Configuration`] with file, line and reason; [`HandError::ConfigurationFile`] where it cannot be read, is no regular file
/// or is larger than 1 MiB.
pub fn read(path: &Path) -> Result<Configuration, HandError> {
    let text = read_regular_file(path, LARGEST)
        .map_err(|source| HandError::ConfigurationFile { path: path.to_path_buf(), source })?;
    parse(&text).map_err(|(line, reason)| HandError::Configuration { file: path.to_path_buf(), line, reason })
}

fn locate() -> Option<PathBuf> {
    if let Some(named) = env::var_os("SUN2XP_CONFIG").filter(|name| !name.is_empty()) {
        return Some(named.into());
    }
    let user = etcetera::choose_base_strategy().ok().map(|strategy| strategy.config_dir());
    let system = env::var_os("XDG_CONFIG_DIRS").filter(|folders| !folders.is_empty()).unwrap_or("/etc/xdg".into());
    // The standard of these folders: relative ones are to be ignored.
    let system = env::split_paths(&system).filter(|folder| folder.is_absolute()).collect::<Vec<_>>();
    let folders = user.into_iter().chain(system);
    let candidates = [PathBuf::from("sun2xp.toml")].into_iter().chain(folders.map(|f| f.join("sun2xp/sun2xp.toml")));
    // A file that is there but unreadable is found, and refused: symlink_metadata needs no permission on the file itself.
    candidates.into_iter().find(|path| path.symlink_metadata().is_ok())
}

/// The line where something is wrong, if it has one, and what.
type Wrong = (Option<usize>, String);

fn parse(text: &str) -> Result<Configuration, Wrong> {
    let line_of = |span: Option<Range<usize>>| line_of(text, span);
    let document = Document::parse(text).map_err(|error| (line_of(error.span()), error.message().to_string()))?;
    let root = document.as_table();
    if let Some((key, _)) = root.iter().find(|(key, _)| !matches!(*key, "hand" | "finger")) {
        let span = root.key(key).and_then(|key| key.span());
        return Err((line_of(span), format!("unknown key `{key}`, expected `hand` or `finger`")));
    }
    // serde names what it found and not where: the line says the rest.
    let failed = |error: toml_edit::de::Error| {
        let line = line_of(error.span());
        let written = line.and_then(|line| text.lines().nth(line - 1)).map(|written| format!("`{}`: ", written.trim()));
        (line, format!("{}{}", written.unwrap_or_default(), error.message()))
    };

    let hand: ConfiguredHand = deserialize(table(root, "hand").map_err(failed_plainly(&line_of))?).map_err(failed)?;
    let all = table(root, "finger").map_err(failed_plainly(&line_of))?;
    let mut common = all.clone();
    for number in 1..=FINGERS {
        common.remove(&number.to_string());
    }
    let mut fingers: [ConfiguredFinger; FINGERS] = Default::default();
    for (index, finger) in fingers.iter_mut().enumerate() {
        let mut merged = common.clone();
        overlay(&mut merged, &table(&all, &(index + 1).to_string()).map_err(failed_plainly(&line_of))?);
        *finger = deserialize(merged).map_err(failed)?;
    }

    let configuration = Configuration { hand, fingers };
    check(&configuration).map_err(|refusal| {
        let key = refusal.unusable.key;
        let (section, span) = match refusal.finger {
            None => {
                let hand = root.get("hand");
                ("hand".to_string(), span_of(hand, key).or_else(|| nearest_table(hand, key)))
            }
            Some(index) => {
                let number = (index + 1).to_string();
                let (own, shared) = (all.get(&number), root.get("finger"));
                let span = span_of(own, key).or_else(|| span_of(shared, key));
                let near = || nearest_table(own, key).or_else(|| nearest_table(shared, key));
                (format!("finger.{number}"), span.or_else(near))
            }
        };
        (line_of(span), format!("{section}.{key}: {}", refusal.unusable.reason))
    })?;
    Ok(configuration)
}

/// The line where a span begins, counted from 1.
pub(super) fn line_of(text: &str, span: Option<Range<usize>>) -> Option<usize> {
    let before = text.get(..span?.start)?;
    Some(before.matches('\n').count() + 1)
}

fn failed_plainly(line_of: &impl Fn(Option<Range<usize>>) -> Option<usize>) -> impl Fn(NotATable) -> Wrong {
    move |NotATable { key, span }| (line_of(span), format!("`{key}` must be a table: [{key}]"))
}

struct NotATable {
    key: String,
    span: Option<Range<usize>>,
}

/// The table behind a key; an empty one where there is no such key. An inline table is a table too.
fn table(parent: &Table, key: &str) -> Result<Table, NotATable> {
    match parent.get(key).cloned() {
        None => Ok(Table::new()),
        Some(Item::Table(table)) => Ok(table),
        Some(Item::Value(Value::InlineTable(table))) => Ok(table.into_table()),
        Some(other) => Err(NotATable { key: key.into(), span: other.span() }),
    }
}

/// Lays `over` on `base`, table by table: what `over` does not name stays.
pub(super) fn overlay(base: &mut Table, over: &Table) {
    for (key, item) in over.iter() {
        let both = (table(base, key), table(over, key));
        let merged = match both {
            (Ok(mut below), Ok(above)) if base.contains_key(key) => {
                overlay(&mut below, &above);
                Item::Table(below)
            }
            _ => item.clone(),
        };
        // The key is taken along, because it knows its line.
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

pub(super) fn deserialize<T: DeserializeOwned>(table: Table) -> Result<T, toml_edit::de::Error> {
    T::deserialize(Value::InlineTable(table.into_inline_table()).into_deserializer())
}

/// Where a dotted key stands in the file, if it stands there.
fn span_of(section: Option<&Item>, dotted: &str) -> Option<Range<usize>> {
    let (path, last) = dotted.rsplit_once('.').unwrap_or(("", dotted));
    let parent = path.split('.').filter(|part| !part.is_empty()).try_fold(section?, |item, part| item.get(part))?;
    parent.as_table_like()?.key(last)?.span()
}

/// Where the innermost table around a dotted key begins. A default does not fit what the file says, so the key itself is not
/// there, but what it does not fit mostly stands beside it.
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
        parse(text).expect_err("refused")
    }

    #[test]
    fn an_empty_file_is_the_default_hand() {
        assert_eq!(parse("").expect("usable"), Configuration::default());
    }

    #[test]
    fn a_finger_overrides_what_all_fingers_share() {
        let text = "[finger]\nbaud = 2000000\n[finger.tendon]\nminimum = 4\nmaximum = 50\n\
                    [finger.2]\nport = '/dev/ttyUSB1'\n[finger.2.tendon]\nminimum = 6\n";
        let hand = parse(text).expect("usable");
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
            ("[finger.3.tendon]\nmaximum = 8\n", Some(2), "null vector"),
            // The key is a default: the table that makes it impossible.
            ("[finger.tendon]\n\nminimum = 40\n", Some(1), "null vector"),
            ("[hand]\nrate = 500\n\n[finger.3.tendon]\nminimum = 40\n", Some(4), "null vector"),
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
