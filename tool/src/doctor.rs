//! `sun2xp doctor`: checks whether this machine can run the hand as configured.

mod examination;
mod finding;
mod machine;
mod measured;
mod ports;

use crate::failure::ExitStatus;
use crate::failure::Failure;
use crate::print::{self, Cell, Look, Progress, Screen, Table, painted};
use examination::examine;
use finding::{Finding, Rating};
use serde::Serialize;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;
use sun2xp::hand::{self, Configured, Fingers, HandError};
use sun2xp::model::configuration::Configuration;

/// Checks the kernel, the resource limits of this process, the cores and the ports. Measures wake-ups and round trips.
/// Reports what to change. The motors stay off.
///
/// Exit status: 0 if the hand can run as configured and at its configured rate, 1 if not, 2 for wrong usage.
#[derive(clap::Args)]
pub struct Arguments {
    /// The configuration file. The default is the file that OpenHand would use.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Duration of the measurements, s.
    #[arg(long, value_name = "S", default_value_t = 3.0, value_parser = seconds)]
    seconds: f64,
    /// Print one JSON object with `pass` and `findings`, for other programs.
    #[arg(long)]
    json: bool,
}

/// The output of `--json`.
#[derive(Serialize)]
struct Examination<'a> {
    pass: bool,
    findings: &'a [Finding],
}

pub fn run(arguments: &Arguments) -> Result<ExitStatus, Failure> {
    let configured = match &arguments.config {
        Some(path) => Configured::read(path)?,
        None => hand::find_configuration()?,
    };
    configured.announce(Fingers::ALL);
    let duration = Duration::from_secs_f64(arguments.seconds);
    let examining = || examine(&configured.configuration, Path::new("/"), duration);
    let findings = Progress::during("examining this machine and its ports", duration, examining)?;
    let pass = findings.iter().all(|finding| finding.verdict < Rating::Failure);
    match arguments.json {
        true => print::json(&Examination { pass, findings: &findings })?,
        false => write!(io::stdout(), "{}", report(&findings, pass, &Screen::stdout()))?,
    }
    Ok(if pass { ExitStatus::SUCCESS } else { ExitStatus::FAILURE })
}

/// Returns the findings that are not good, each in one line.
///
/// # Errors
/// Returns an error if the hand cannot be examined.
pub fn complaints(configuration: &Configuration, duration: Duration) -> Result<Vec<String>, HandError> {
    let findings = examine(configuration, Path::new("/"), duration)?;
    let line = |Finding { subject, found, advice, .. }: Finding| format!("{subject}: {found}. {advice}");
    Ok(findings.into_iter().filter(|finding| finding.verdict > Rating::Good).map(line).collect())
}

/// Returns one row for each finding, with the advice below what was found, and then a line that says `pass` or `fail`.
fn report(findings: &[Finding], pass: bool, screen: &Screen) -> String {
    let mut table = Table::without_header();
    for Finding { subject, verdict, found, advice } in findings {
        let mark = match verdict {
            Rating::Good => Cell::new(Look::Good, "good"),
            Rating::Warning => Cell::new(Look::Warning, "warning"),
            Rating::Failure => Cell::new(Look::Bad, "FAILURE"),
        };
        let gap = if advice.is_empty() { "" } else { "\n" };
        table.row([mark, subject.into(), format!("{found}{gap}{advice}").into()]);
    }
    let (look, word) = if pass { (Look::Good, "pass") } else { (Look::Bad, "fail") };
    format!("{}{}\n", table.text(screen), painted(screen, look, word))
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if (0.1..=60.0).contains(&seconds) => Ok(seconds),
        _ => Err("not a time of 0.1 to 60 seconds".into()),
    }
}
