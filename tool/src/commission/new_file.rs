//! Creates the configuration file of a finger, after a search for the board of this finger.

use super::port_search::{Answer, search};
use crate::failure::{Failure, wrong_usage};
use std::io::{self, ErrorKind, Write};
use std::path::Path;
use sun2xp::files::{create_file, write_remedy};
use sun2xp::model::configuration::Configuration;
use sun2xp::model::{FingerNumber, ShownPath};

/// Searches these ports, or the default ones, and writes a file with the finger that answers.
pub fn create(file: &Path, finger: FingerNumber, ports: &[String]) -> Result<(), Failure> {
    let defaults = Configuration::default();
    let patterns = if ports.is_empty() { &defaults.hand.search_ports } else { ports };
    let chosen = search(patterns, defaults.fingers[finger.index()].baud, finger, &[]).map_err(|reason| {
        wrong_usage(format!("{} does not exist, and no board was chosen for a new file: {reason}", ShownPath(file)))
    })?;
    let text = text(finger, &chosen.answer, ports);
    place(file, &text)?;
    writeln!(io::stdout(), "{} Created {}.", chosen.text(), ShownPath(file))?;
    Ok(())
}

/// Creates the file. If another process has created a file of this name during the search, that file stays.
fn place(file: &Path, text: &str) -> Result<(), Failure> {
    let shown = ShownPath(file);
    let name = file.file_name().and_then(|name| name.to_str());
    let name = name.ok_or_else(|| format!("cannot create {shown}: its name is not UTF-8: choose another name"))?;
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    match create_file(folder, [name.to_string()], |output| output.write_all(text.as_bytes())) {
        Ok(_) => Ok(()),
        Err(error) if error.kind() == ErrorKind::AlreadyExists => {
            Err(format!("another process has created {shown} meanwhile: run the tool again").into())
        }
        Err(error) => Err(format!("cannot create {shown}: {error}{}", write_remedy(&error)).into()),
    }
}

fn text(finger: FingerNumber, answer: &Answer, ports: &[String]) -> String {
    let search = if ports.is_empty() { String::new() } else { search_ports(ports) };
    let (number, address) = (answer.number(), answer.found.address);
    let counts = answer.counts_per_revolution().map_or(String::new(), |counts| {
        format!("\n[finger.{finger}.encoder]\ncounts_per_revolution = [{counts}, {counts}, {counts}, {counts}]\n")
    });
    format!(
        "# Created by sun2xp commission. docs/sun2xp.toml describes every key.\n[hand]\nfingers = [{finger}]\n\
         {search}\n[finger.{finger}]\nboard = \"{number}\"\naddress = {address}\n{counts}"
    )
}

/// Returns the line for these ports. `toml_edit` writes the texts, because TOML and Rust have different escapes.
fn search_ports(ports: &[String]) -> String {
    let listed: toml_edit::Array = ports.iter().collect();
    format!("search_ports = {listed}\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_file_that_appears_during_the_search_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("hand.toml");
        place(&file, "first").expect("created");
        let refused = place(&file, "second").expect_err("there is a file").to_string();
        assert!(refused.ends_with("meanwhile: run the tool again"), "{refused}");
        assert_eq!(fs::read_to_string(&file).expect("a file"), "first");
    }

    #[test]
    fn ports_with_control_characters_are_valid_toml() {
        let ports = ["/dev/ttyUSB*".to_string(), "\u{1b}\"\u{0}".to_string()];
        let line = search_ports(&ports);
        let read: toml_edit::DocumentMut = line.parse().expect("TOML");
        let read = read["search_ports"].as_array().expect("an array").iter().map(|port| port.as_str().expect("text"));
        assert_eq!(read.collect::<Vec<_>>(), ports, "{line}");
    }
}
