//! What the examination has found, and how serious a finding is.

use serde::Serialize;
use sun2xp::model::configuration::{Configuration, RealTime};

/// How serious a finding is, from harmless to grave.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Rating {
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
    pub verdict: Rating,
    /// What is there, with numbers and units.
    pub found: String,
    /// What that means and how to mend it; empty where it is good.
    pub advice: String,
}

impl Finding {
    pub(super) fn good(subject: impl Into<String>, found: impl Into<String>) -> Self {
        Self::new(Rating::Good, subject, found, "")
    }

    pub(super) fn new(
        verdict: Rating,
        subject: impl Into<String>,
        found: impl Into<String>,
        advice: impl Into<String>,
    ) -> Self {
        Self { subject: subject.into(), verdict, found: found.into(), advice: advice.into() }
    }
}

/// What it is to lack something that makes a thread real-time.
pub(super) fn lacking(configuration: &Configuration, subject: &str, found: String, advice: String) -> Finding {
    match configuration.hand.real_time {
        RealTime::Enforce => Finding::new(Rating::Failure, subject, found, advice),
        RealTime::Try => Finding::new(Rating::Warning, subject, found, advice),
        RealTime::Ignore => Finding::good(subject, found),
    }
}
