//! `sun2xp boards`: lists the boards at serial ports with their unique numbers.

use crate::failure::Failure;
use crate::print::{self, Cell, Look, Screen, Table};
use serde::Serialize;
use std::collections::BTreeSet;
use std::io::{self, Write};
use std::path::PathBuf;
use sun2xp::hand::{self, SearchedPort, search_boards};
use sun2xp::model::ShownPath;
use sun2xp::model::configuration::{BoardNumber, Configuration};

/// Lists the boards at the serial ports, with the unique numbers of their fingers for `finger.board` of a
/// configuration. A serial device is not opened if this user can see that another program uses it. Boards only get a
/// Hello, which changes nothing.
#[derive(clap::Args)]
pub struct Arguments {
    /// The configuration file whose `hand.search_ports` and `finger.baud` are used. Without it, the defaults are used.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Search these ports instead of `hand.search_ports`. A * in the last part of the path stands for any text. May be
    /// repeated.
    #[arg(long = "port", value_name = "PATH")]
    ports: Vec<String>,
    /// Try this bit rate, bit/s. May be repeated. The default is finger.baud.
    #[arg(long = "baud", value_name = "B", value_parser = clap::value_parser!(u32).range(9600..=12_000_000))]
    rates: Vec<u32>,
    /// Print one JSON object with `ports`, for other programs.
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Report {
    ports: Vec<Port>,
}

/// What was found at a port.
#[derive(Serialize)]
struct Port {
    port: PathBuf,
    fingers: Vec<Finger>,
    /// Why no finger was found.
    error: Option<String>,
    /// The error and its remedy in a few words, for the table.
    #[serde(skip)]
    why: String,
}

/// A finger that answers at a port.
#[derive(Serialize)]
struct Finger {
    address: u8,
    /// The number in the form that `finger.board` takes.
    unique_number: BoardNumber,
    firmware: String,
    board_kind: u16,
}

impl Port {
    fn new(searched: SearchedPort) -> Self {
        let port = searched.path;
        match searched.answer {
            Ok(found) => {
                let fingers = found.into_iter().map(|found| Finger {
                    address: found.address,
                    unique_number: BoardNumber(found.identity.unique_number),
                    firmware: found.identity.firmware.0.map(|part| part.to_string()).join("."),
                    board_kind: found.identity.board_kind,
                });
                Self { port, fingers: fingers.collect(), error: None, why: String::new() }
            }
            Err(error) => Self { port, fingers: Vec::new(), error: Some(error.to_string()), why: error.in_short() },
        }
    }

    fn add_to(&self, table: &mut Table) {
        let path = ShownPath(&self.port).to_string();
        if self.fingers.is_empty() {
            table.row([path.clone().into(), Cell::new(Look::Dim, self.why.as_str()), "".into(), "".into(), "".into()]);
        }
        for finger in &self.fingers {
            table.row([
                path.clone().into(),
                finger.unique_number.to_string().into(),
                finger.address.to_string().into(),
                finger.firmware.clone().into(),
                kind(finger.board_kind).into(),
            ]);
        }
    }
}

fn kind(number: u16) -> String {
    match number {
        0 => "unspecified".into(),
        1 => "simulated".into(),
        2 => "reference firmware".into(),
        other => format!("{other:#06x}"),
    }
}

pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let configuration = match &arguments.config {
        Some(path) => hand::Configured::read(path)?.configuration,
        None => Configuration::default(),
    };
    let patterns = if arguments.ports.is_empty() { &configuration.hand.search_ports } else { &arguments.ports };
    let configured: BTreeSet<u32> = configuration.fingers.iter().map(|finger| finger.baud).collect();
    let rates = if arguments.rates.is_empty() { configured.into_iter().collect() } else { arguments.rates.clone() };
    let report = Report { ports: search_boards(patterns, &rates).into_iter().map(Port::new).collect() };
    if arguments.json {
        print::json(&report)?;
        return Ok(());
    }
    let mut output = io::stdout();
    if report.ports.is_empty() {
        writeln!(output, "no serial port at {}: connect a board, or name a port with --port", patterns.join(", "))?;
        return Ok(());
    }
    let mut table = Table::new(["port", "unique number", "address", "firmware", "kind"]).numeric(2..3);
    report.ports.iter().for_each(|port| port.add_to(&mut table));
    write!(output, "{}", table.text(&Screen::stdout()))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use sun2xp::board::{LinkError, PortError};

    #[test]
    fn the_table_says_why_a_port_has_no_board_and_what_to_do() {
        let path = PathBuf::from("/dev/ttyUSB0");
        for (error, shown) in [
            (
                LinkError::from(PortError::Forbidden(path.clone())),
                "no permission: join the port's group (usually dialout)",
            ),
            (LinkError::WrongVersion { lowest: 2, highest: 3 }, "the board has protocol 2 to 3, the library 1: update"),
            (LinkError::Unintelligible { bytes: 9, damaged: 1 }, "no valid frame: check the bit rate"),
        ] {
            let mut table = Table::new(["port", "unique number", "address", "firmware", "kind"]);
            Port::new(SearchedPort { path: path.clone(), answer: Err(error) }).add_to(&mut table);
            let text = table.text(&Screen { width: None, lines: false, coloured: false });
            assert!(text.contains("/dev/ttyUSB0") && text.contains(shown), "{text}");
        }
    }
}
