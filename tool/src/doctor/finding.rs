//! A finding of the doctor, and its rating.

use serde::Serialize;
use sun2xp::model::configuration::{Configuration, RealTime};

/// Rating of a finding, from harmless to serious.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Rating {
    /// Nothing needs to be changed.
    Good,
    /// The hand runs, but worse than it could.
    Warning,
    /// The hand cannot be opened, or misses its deadlines.
    Failure,
}

/// The result of one check.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Finding {
    /// What was checked.
    pub subject: String,
    /// The rating.
    pub verdict: Rating,
    /// What was found, with numbers and units.
    pub found: String,
    /// What that means, and how to fix it; empty if the rating is good.
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

/// The finding for a missing permission that a real-time thread needs.
pub(super) fn lacking(configuration: &Configuration, subject: &str, found: String, advice: String) -> Finding {
    match configuration.hand.real_time {
        RealTime::Enforce => Finding::new(Rating::Failure, subject, found, advice),
        RealTime::Try => Finding::new(Rating::Warning, subject, found, advice),
        RealTime::Ignore => Finding::good(subject, found),
    }
}
