//! The time for which a set point is valid.

use std::time::Duration;

/// How long the set point or path that was sent last to a finger is valid. `hold_after` and `end_after` count from
/// `since`. A path that is sent with this validity prolongs both times by the time until the end of the path. If one of
/// these times is none, the configured time applies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Validity {
    /// After this time the finger reacts as `finger.motion.on_expiry` says. The configured time is
    /// `finger.motion.valid_ms`, which may be absent: then a set point does not expire.
    pub hold_after: Option<Duration>,
    /// After this time the finger faults, and its board goes to the end state. The configured time is the time of
    /// `hold_after` plus `finger.motion.end_state_ms`, which may be absent.
    pub end_after: Option<Duration>,
    /// The time from which both times count, ns of the clock CLOCK_MONOTONIC. If it is none, they count from the cycle
    /// in which the servo takes what was sent. A program that only passes on what others send gives the time, so that a
    /// delay in the program does not prolong the validity.
    pub since: Option<u64>,
}

impl Validity {
    /// Returns a validity after which the finger reacts as `finger.motion.on_expiry` says. If `time` is none, the
    /// configured time applies.
    #[must_use]
    pub fn hold_after(time: Option<Duration>) -> Self {
        Self { hold_after: time, ..Self::default() }
    }
}

/// A validity that was renewed without a new set point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Renewal {
    /// Number of the set point that a planner sent last before the renewal. A set point that was sent later has its own
    /// validity.
    pub number: u32,
    pub validity: Validity,
}
