//! Whether this machine and its ports can run a hand as it is configured, and what to change where not.

mod machine;
mod measured;
mod ports;

use crate::hand::opening::{check, simulate};
use crate::hand::{Fingers, HandError};
use crate::model::configuration::{Configuration, RealTime};
use serde::Serialize;
use std::path::Path;
use std::time::Duration;

/// How serious a finding is, from harmless to grave.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// As it should be.
    Good,
    /// The hand runs, but worse than it could.
    Warning,
    /// The hand cannot be opened, or does not keep its periods.
    Failure,
}

/// One thing that was looked at.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// What was looked at.
    pub subject: String,
    /// What is to be thought of it.
    pub verdict: Verdict,
    /// What is there, with numbers and units.
    pub found: String,
    /// What that means and how to mend it; empty where it is good.
    pub advice: String,
}

impl Finding {
    fn good(subject: impl Into<String>, found: impl Into<String>) -> Self {
        Self::new(Verdict::Good, subject, found, "")
    }

    fn new(verdict: Verdict, subject: impl Into<String>, found: impl Into<String>, advice: impl Into<String>) -> Self {
        Self { subject: subject.into(), verdict, found: found.into(), advice: advice.into() }
    }
}

/// Looks at the machine, whose files are below `root` (`/`, but for tests), and at the ports of a hand, which must be closed. Measures for
/// about `duration`. Motors stay off.
///
/// # Errors
/// A configuration that cannot be used, a system that refuses a thread or a pseudo-terminal.
pub fn examine(configuration: &Configuration, root: &Path, duration: Duration) -> Result<Vec<Finding>, HandError> {
    check(configuration)?;
    let mut findings = machine::findings(configuration, root);
    findings.extend(measured::wake_ups(configuration, duration / 2)?);
    let simulated = simulate(configuration, Fingers::ALL)?;
    findings.extend(ports::findings(configuration, &simulated, root, duration / 2)?);
    Ok(findings)
}

/// What it is to lack something that makes a thread real-time.
fn lacking(configuration: &Configuration, subject: &str, found: String, advice: String) -> Finding {
    match configuration.hand.real_time {
        RealTime::Enforce => Finding::new(Verdict::Failure, subject, found, advice),
        RealTime::Try => Finding::new(Verdict::Warning, subject, found, advice),
        RealTime::Ignore => Finding::good(subject, found),
    }
}
