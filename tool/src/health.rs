//! `sun2xp health`: compares measurements of a finger today with those of its commissioning.

pub mod comparison;

use crate::commission::{Examined, examine};
use crate::failure::{ExitStatus, Failure};
use crate::print::{self, Cell, Look, Screen, Table, painted};
use comparison::{Complaint, compare};
use serde::Serialize;
use std::io::{self, Write};
use std::path::PathBuf;
use sun2xp::model::FingerNumber;

/// Measures a finger as `sun2xp commission` does, and compares the results with the results of commissioning: zeros,
/// pretension, stiffness, friction. Names what to tension, replace or lubricate. Changes no file.
///
/// The finger moves through its whole workspace, which must be free. The measurements take two to three minutes.
///
/// Exit status: 0 if nothing has changed beyond its limit, 1 if something has or if the measurement failed, 2 for wrong
/// usage.
#[derive(clap::Args)]
pub struct Arguments {
    /// The configuration file, for example hand.toml. The file hand.commission.json beside it then has the results of
    /// the commissioning.
    #[arg(long, value_name = "FILE")]
    config: PathBuf,
    /// The finger.
    #[arg(long, value_name = "N", default_value = "1", value_parser = crate::commission::finger)]
    finger: FingerNumber,
    /// Do not wait for Enter. Use this only if the space around the finger is free. If the finger is zeroed at a pose,
    /// a machine must hold the finger in this pose when the tool asks for it, and let it go when the tool asks for
    /// that.
    #[arg(long)]
    yes: bool,
    /// Print one JSON object with `healthy` and `findings`, for other programs. Implies --yes. The requests to hold the
    /// finger and to let it go are not printed.
    #[arg(long)]
    json: bool,
}

/// The output of `--json`.
#[derive(Serialize)]
struct Report {
    healthy: bool,
    findings: Vec<Complaint>,
}

pub fn run(arguments: &Arguments) -> Result<ExitStatus, Failure> {
    let Examined { before, today } =
        examine(&arguments.config, arguments.finger, arguments.yes || arguments.json, arguments.json)?;
    let findings = compare(&before.0, &before.1, &today.0, &today.1);
    let healthy = findings.is_empty();
    match arguments.json {
        true => print::json(&Report { healthy, findings })?,
        false => write!(io::stdout(), "{}", text(&findings, &Screen::stdout()))?,
    }
    Ok(if healthy { ExitStatus::SUCCESS } else { ExitStatus::FAILURE })
}

fn text(findings: &[Complaint], screen: &Screen) -> String {
    if findings.is_empty() {
        return painted(screen, Look::Good, "healthy: nothing has changed beyond its limit") + "\n";
    }
    let mut table = Table::new(["part", "commissioned", "today", "what to do"]);
    for Complaint { part, before, today, advice, .. } in findings {
        table.row([
            Cell::new(Look::Warning, part.as_str()),
            before.as_str().into(),
            today.as_str().into(),
            (*advice).into(),
        ]);
    }
    table.text(screen)
}
