//! A configuration file for a finger that has none: searches for its board.

use crate::failure::{Failure, wrong_usage};
use std::io::{self, Write};
use std::path::Path;
use sun2xp::files::replace_file;
use sun2xp::hand::{FoundFinger, search_boards};
use sun2xp::model::configuration::{BoardNumber, Configuration};
use sun2xp::model::{FingerNumber, Shown, ShownPath};

/// Searches these ports, or the default ones, and writes a file with the only finger that answers.
pub fn create(file: &Path, finger: FingerNumber, ports: &[String]) -> Result<(), Failure> {
    let defaults = Configuration::default();
    let patterns = if ports.is_empty() { &defaults.hand.search_ports } else { ports };
    let searched = search_boards(patterns, &[defaults.fingers[finger.index()].baud]);
    let mut answers = Vec::new();
    for port in &searched {
        for found in port.answer.iter().flatten() {
            answers.push((&port.path, found));
        }
    }
    // A board can have several fingers. One with the address of this finger is the right one.
    if answers.len() > 1 && answers.iter().any(|(_, found)| i32::from(found.address) == finger.get()) {
        answers.retain(|(_, found)| i32::from(found.address) == finger.get());
    }
    let [(port, found)] = answers[..] else { return Err(refusal(file, &answers, patterns)) };
    let number = BoardNumber(found.identity.unique_number);
    let text = text(finger, found, ports);
    replace_file(file, |output| output.write_all(text.as_bytes()))
        .map_err(|error| format!("cannot create {}: {error}", ShownPath(file)))?;
    writeln!(io::stdout(), "The board {number} answers at {}. Created {}.", ShownPath(port), ShownPath(file))?;
    Ok(())
}

fn text(finger: FingerNumber, found: &FoundFinger, ports: &[String]) -> String {
    let number = BoardNumber(found.identity.unique_number);
    let search = if ports.is_empty() { String::new() } else { format!("search_ports = {ports:?}\n") };
    let address = found.address;
    let counts = match found.identity.counts_per_revolution {
        0 => String::new(),
        counts => {
            format!("\n[finger.{finger}.encoder]\ncounts_per_revolution = [{counts}, {counts}, {counts}, {counts}]\n")
        }
    };
    format!(
        "# Created by sun2xp commission. docs/configuration.md describes every key.\n[hand]\nfingers = [{finger}]\n\
         {search}\n[finger.{finger}]\nboard = \"{number}\"\naddress = {address}\n{counts}"
    )
}

fn refusal(file: &Path, answers: &[(&std::path::PathBuf, &FoundFinger)], patterns: &[String]) -> Failure {
    let list = |(port, found): &(&std::path::PathBuf, &FoundFinger)| {
        format!("{} address {} at {}", BoardNumber(found.identity.unique_number), found.address, ShownPath(port))
    };
    let patterns = Shown(&patterns.join(", ")).to_string();
    wrong_usage(match answers {
        [] => format!(
            "{} does not exist, and no board answers at {patterns}: connect and switch on the board, or name its port \
             with --port",
            ShownPath(file)
        ),
        several => format!(
            "{} does not exist, and {} fingers answer: {}. Connect only one, or name its port with --port",
            ShownPath(file),
            several.len(),
            several.iter().map(list).collect::<Vec<_>>().join("; ")
        ),
    })
}
