//! `sun2xp doctor`: checks whether this machine can run the hand as configured.

mod examination;
mod finding;
mod machine;
mod measured;
mod ports;

use crate::failure::Failure;
use examination::examine;
use finding::{Finding, Rating};
use serde::Serialize;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;
use sun2xp::hand::{self, Configured, Fingers};

/// Checks the kernel, the resource limits of this process, the cores and the ports. Measures wake-ups and round trips.
/// Reports what to change. The motors stay off.
///
/// The exit status is 0 if the hand can run as configured and at its configured rate, and 1 otherwise.
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

pub fn run(arguments: &Arguments) -> Result<ExitCode, Failure> {
    let configured = match &arguments.config {
        Some(path) => Configured::read(path)?,
        None => hand::find_configuration()?,
    };
    configured.announce(Fingers::ALL);
    let findings = examine(&configured.configuration, Path::new("/"), Duration::from_secs_f64(arguments.seconds))?;
    let pass = findings.iter().all(|finding| finding.verdict < Rating::Failure);
    let mut output = io::stdout().lock();
    if arguments.json {
        writeln!(output, "{}", serde_json::to_string_pretty(&Examination { pass, findings: &findings })?)?;
    } else {
        findings.iter().try_for_each(|finding| report(&mut output, finding))?;
        writeln!(output, "{}", if pass { "pass" } else { "fail" })?;
    }
    Ok(if pass { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

fn report(output: &mut impl Write, finding: &Finding) -> io::Result<()> {
    let mark = match finding.verdict {
        Rating::Good => "good   ",
        Rating::Warning => "warning",
        Rating::Failure => "FAILURE",
    };
    writeln!(output, "{mark}  {}: {}", finding.subject, finding.found)?;
    if finding.advice.is_empty() { Ok(()) } else { writeln!(output, "         {}", finding.advice) }
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if (0.1..=60.0).contains(&seconds) => Ok(seconds),
        _ => Err("not a time of 0.1 to 60 seconds".into()),
    }
}
