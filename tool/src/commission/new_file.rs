//! A configuration file for a finger that has none: searches for its board.

use super::port_search::{Answer, search};
use crate::failure::{Failure, wrong_usage};
use std::io::{self, Write};
use std::path::Path;
use sun2xp::files::replace_file;
use sun2xp::model::configuration::Configuration;
use sun2xp::model::{FingerNumber, ShownPath};

/// Searches these ports, or the default ones, and writes a file with the finger that answers.
pub fn create(file: &Path, finger: FingerNumber, ports: &[String]) -> Result<(), Failure> {
    let defaults = Configuration::default();
    let patterns = if ports.is_empty() { &defaults.hand.search_ports } else { ports };
    let chosen = search(patterns, defaults.fingers[finger.index()].baud, finger, &[])
        .map_err(|reason| wrong_usage(format!("{} does not exist, and {reason}", ShownPath(file))))?;
    let text = text(finger, &chosen.answer, ports);
    replace_file(file, |output| output.write_all(text.as_bytes()))
        .map_err(|error| format!("cannot create {}: {error}", ShownPath(file)))?;
    writeln!(io::stdout(), "{} Created {}.", chosen.text(), ShownPath(file))?;
    Ok(())
}

fn text(finger: FingerNumber, answer: &Answer, ports: &[String]) -> String {
    let search = if ports.is_empty() { String::new() } else { format!("search_ports = {ports:?}\n") };
    let (number, address) = (answer.number(), answer.found.address);
    let counts = answer.counts_per_revolution().map_or(String::new(), |counts| {
        format!("\n[finger.{finger}.encoder]\ncounts_per_revolution = [{counts}, {counts}, {counts}, {counts}]\n")
    });
    format!(
        "# Created by sun2xp commission. docs/configuration.md describes every key.\n[hand]\nfingers = [{finger}]\n\
         {search}\n[finger.{finger}]\nboard = \"{number}\"\naddress = {address}\n{counts}"
    )
}
