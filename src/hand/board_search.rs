//! Finds boards at serial ports by their unique numbers.

use crate::board::protocol::Identity;
use crate::board::{Link, LinkError, PortError};
use crate::hand::HandError;
use crate::hand::opening::check;
use crate::model::configuration::{BoardNumber, Configuration};
use crate::model::{FingerNumber, Fingers, ShownPath};
use crate::realtime::now;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Time in which a board must answer at one port, ns. A board answers a Hello within 50 ms. The time permits three
/// attempts, because a Hello may be lost.
const ANSWER: u64 = 160_000_000;

/// Time for which the ports are searched again if a board is missing. Some boards restart when their port is opened.
const PATIENCE: Duration = Duration::from_secs(2);

/// Time between two searches. If no port exists, a search returns at once. Without this pause, the thread would then
/// use its core fully.
const PAUSE: Duration = Duration::from_millis(50);

/// A finger that answers at a port.
#[derive(Clone, Debug)]
pub struct FoundFinger {
    /// Its address on the board, 1 to 15.
    pub address: u8,
    /// Its identity.
    pub identity: Identity,
}

/// A port that was searched.
#[derive(Debug)]
pub struct SearchedPort {
    /// Path of the port.
    pub path: PathBuf,
    /// The fingers that answer at the port, or the reason why there are none.
    pub answer: Result<Vec<FoundFinger>, LinkError>,
}

/// Queries the identity of every finger at every port that the patterns name. Only a Hello is sent, which changes
/// nothing on a board. A serial device that another program has open is not touched, if this user may see the open
/// files of that program. The search takes at most 160 ms for each bit rate at each port, and at most 100 ms more for
/// each further finger of the board.
///
/// `baud` are the bit rates to try at each port, bit/s. A * in the last part of a pattern stands for any text.
pub fn search_boards(patterns: &[String], baud: &[u32]) -> Vec<SearchedPort> {
    let used = used_terminals();
    let search = |path: PathBuf| SearchedPort {
        answer: match std::fs::canonicalize(&path) {
            Ok(device) if used.contains(&device) => Err(PortError::Busy(path.clone()).into()),
            _ => ask(&path, baud),
        },
        path,
    };
    candidates(patterns).into_iter().map(search).collect()
}

/// Sets the port of each of these fingers whose board is configured by its unique number.
pub fn find_boards(configuration: &mut Configuration, fingers: Fingers) -> Result<(), HandError> {
    let missing: Vec<(FingerNumber, BoardNumber)> =
        fingers.members().filter_map(|finger| Some((finger, configuration.fingers[finger.index()].board?))).collect();
    if missing.is_empty() {
        return Ok(());
    }
    let rates: BTreeSet<u32> = missing.iter().map(|(finger, _)| configuration.fingers[finger.index()].baud).collect();
    let rates: Vec<u32> = rates.into_iter().collect();
    let begun = Instant::now();
    loop {
        let searched = search_boards(&configuration.hand.search_ports, &rates);
        let found: Result<Vec<PathBuf>, HandError> =
            missing.iter().map(|&(finger, number)| port_of(finger, number, configuration, &searched)).collect();
        match found {
            Ok(paths) => {
                for ((finger, _), path) in missing.iter().zip(paths) {
                    // The configuration has paths in UTF-8. Paths below /dev are ASCII, so this conversion keeps them.
                    configuration.fingers[finger.index()].port = path.to_string_lossy().into_owned();
                }
                // This check refuses fingers at the same port with different threads or bit rates.
                return Ok(check(configuration)?);
            }
            Err(error) if begun.elapsed() > PATIENCE => return Err(error),
            Err(_) => sleep(PAUSE),
        }
    }
}

/// Returns the port at which the board with this unique number answers. Returns an error if there is no such port, or
/// more than one.
fn port_of(
    finger: FingerNumber,
    number: BoardNumber,
    configuration: &Configuration,
    searched: &[SearchedPort],
) -> Result<PathBuf, HandError> {
    let is_wanted = |found: &FoundFinger| found.identity.unique_number == number.0;
    let mut ports = searched.iter().filter(|port| port.answer.iter().flatten().any(is_wanted));
    let result = match (ports.next(), ports.next()) {
        (Some(port), None) => return Ok(port.path.clone()),
        (Some(_), Some(_)) => "found at several of the ports",
        (None, _) => "not found at",
    };
    let patterns = configuration.hand.search_ports.join(", ");
    Err(HandError::NoSuchBoard { finger, number, patterns, found: found_at(searched), searched: result })
}

/// Says in one line what a search has found at each port.
pub fn found_at(searched: &[SearchedPort]) -> String {
    let at_port = |port: &SearchedPort| {
        let path = ShownPath(&port.path);
        match &port.answer {
            Ok(fingers) => {
                let numbers = fingers.iter().map(|found| BoardNumber(found.identity.unique_number).to_string());
                format!("{path} has {}", numbers.collect::<Vec<_>>().join(" and "))
            }
            Err(error) => format!("{path}: {}", error.in_short()),
        }
    };
    match searched {
        [] => "no port".into(),
        _ => searched.iter().map(at_port).collect::<Vec<_>>().join("; "),
    }
}

fn ask(path: &Path, rates: &[u32]) -> Result<Vec<FoundFinger>, LinkError> {
    let mut refusal = LinkError::Silent { milliseconds: 0 };
    for &baud in rates {
        let identities = Link::open(path, baud).and_then(|mut link| link.identities(now() + ANSWER));
        match identities {
            Ok(fingers) => {
                let found = |(address, identity)| FoundFinger { address, identity };
                return Ok(fingers.into_iter().map(found).collect());
            }
            // A board has answered, so this bit rate is the right one.
            Err(error @ (LinkError::WrongVersion { .. } | LinkError::Refused { .. })) => return Err(error),
            Err(error) => refusal = error,
        }
    }
    Err(refusal)
}

/// The serial devices that processes have open, as far as this user can see them. Such a port is not opened, even if it
/// is not locked: settings and bytes would disturb the process that uses it. Pseudo-terminals are left out, because the
/// process that simulates a board may itself have both ends of its pseudo-terminal open.
fn used_terminals() -> BTreeSet<PathBuf> {
    let entries = |folder: PathBuf| std::fs::read_dir(folder).into_iter().flatten().flatten();
    let descriptors = entries("/proc".into()).flat_map(|process| entries(process.path().join("fd")));
    let files = descriptors.filter_map(|descriptor| std::fs::read_link(descriptor.path()).ok());
    files.filter(|file| file.to_string_lossy().starts_with("/dev/tty")).collect()
}

/// The files that the patterns name, each once, though several links may lead to it.
fn candidates(patterns: &[String]) -> Vec<PathBuf> {
    let mut devices = BTreeSet::new();
    let mut paths = Vec::new();
    for path in patterns.iter().flat_map(|pattern| matching(Path::new(pattern))) {
        // A dangling link leads to no device.
        if let Ok(device) = std::fs::canonicalize(&path)
            && devices.insert(device)
        {
            paths.push(path);
        }
    }
    paths
}

/// The paths that a pattern names, in the order of their names.
fn matching(pattern: &Path) -> Vec<PathBuf> {
    let name = pattern.file_name().unwrap_or_default().to_string_lossy();
    if !name.contains('*') {
        return vec![pattern.to_owned()];
    }
    let folder = pattern.parent().unwrap_or(Path::new("."));
    // A folder that does not exist has no ports. udev removes /dev/serial when the last adapter is unplugged.
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let fitting = entries.filter(|entry| fits(&entry.file_name().to_string_lossy(), &name));
    let mut paths: Vec<PathBuf> = fitting.map(|entry| entry.path()).collect();
    paths.sort();
    paths
}

/// Returns whether a name fits a pattern in which each * stands for any text.
fn fits(name: &str, pattern: &str) -> bool {
    match pattern.split_once('*') {
        None => name == pattern,
        Some((start, rest)) => name.strip_prefix(start).is_some_and(|end| {
            let places = end.char_indices().map(|(place, _)| place).chain([end.len()]);
            places.map(|place| &end[place..]).any(|end| fits(end, rest))
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::board::protocol::{Capabilities, FirmwareVersion};

    #[test]
    fn a_board_that_is_missing_or_answers_at_several_ports_is_refused() {
        let identity = Identity {
            version: 1,
            addresses: 0b10,
            board_kind: 0,
            unique_number: [7; 12],
            firmware: FirmwareVersion::default(),
            counts_per_revolution: 0,
            gauge_bits: 12,
            torque_unit: 1000,
            torque_limit: 1000,
            shortest_watchdog_ms: 2,
            capabilities: Capabilities::default(),
        };
        let answers =
            |path: &str| SearchedPort { path: path.into(), answer: Ok(vec![FoundFinger { address: 1, identity }]) };
        let refused = |ports: &[SearchedPort]| {
            let number = BoardNumber(identity.unique_number);
            let refused = port_of(FingerNumber::ONE, number, &Configuration::default(), ports);
            refused.expect_err("refused").to_string()
        };
        let (none, three) = (refused(&[]), refused(&["/dev/a", "/dev/b", "/dev/c"].map(answers)));
        assert!(none.contains("was not found at /dev/") && none.contains("Found: no port"), "{none}");
        assert!(three.contains("was found at several of the ports /dev/"), "{three}");
    }

    #[test]
    fn a_star_stands_for_any_text() {
        for (name, pattern) in [("ttyUSB0", "ttyUSB*"), ("a-b-c", "a*c"), ("a-b-c", "*-b-*"), ("", "*"), ("x", "x")] {
            assert!(fits(name, pattern), "{name} {pattern}");
        }
        for (name, pattern) in [("ttyACM0", "ttyUSB*"), ("a-b-d", "a*c"), ("x", "y"), ("abc", "a*bb*")] {
            assert!(!fits(name, pattern), "{name} {pattern}");
        }
    }

    #[test]
    fn a_device_with_several_names_is_a_candidate_once() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("tty0"), "").expect("a file");
        std::os::unix::fs::symlink(at("tty0"), at("id-left")).expect("a link");
        std::os::unix::fs::symlink(at("none"), at("id-dangling")).expect("a link");
        let patterns = ["id-*", "tty*", "none*"].map(|name| at(name).display().to_string());
        assert_eq!(candidates(&patterns), [at("id-left")]);
    }
}
