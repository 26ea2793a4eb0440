//! The dead man's handle, as the server counts it: how long the owner may still be silent. The servos count the same
//! times themselves, so they catch the fingers in time even if the server hangs.
//!
//! To catch a finger means to let it hold its pose softly because its Target is no longer valid.

use std::time::Duration;
use sun2xp::motion::Validity;

/// A millisecond, ns.
pub const MILLISECOND: u64 = 1_000_000;

/// The moment from which the owner's silence counts, and how long the owner may be silent.
#[derive(Clone, Copy, Debug)]
pub struct Silence {
    /// The moment from which the validity of the newest Target counts, ns.
    received: u64,
    /// The validity of the newest Target, ns.
    validity: u64,
    /// The time after `received` at which every finger goes to its end state, ns.
    end: u64,
}

impl Silence {
    /// Returns the silence after an acquire at `now`, ns. The acquire counts as a Target with the validity `catch_ms`.
    #[must_use]
    pub fn after_acquire(now: u64, catch_ms: u32, end_ms: u32) -> Self {
        let nanoseconds = |milliseconds| u64::from(milliseconds) * MILLISECOND;
        Self { received: now, validity: nanoseconds(catch_ms), end: nanoseconds(end_ms) }
    }

    /// Notes the newest Target. Its validity counts from `received`, ns.
    pub fn renew(&mut self, received: u64, validity: u64) {
        (self.received, self.validity) = (received, validity);
    }

    /// Returns the validity of the set point of a finger that the owner has commanded.
    #[must_use]
    pub fn of_commanded(&self) -> Validity {
        Validity { hold_after: Some(Duration::from_nanos(self.validity)), ..self.of_other() }
    }

    /// Returns the validity of the set point of a finger that the owner has not commanded. Such a finger is not caught,
    /// but it goes to its end state.
    #[must_use]
    pub fn of_other(&self) -> Validity {
        Validity { hold_after: None, end_after: Some(Duration::from_nanos(self.end)), since: Some(self.received) }
    }

    /// Returns whether the newest Target is still valid.
    #[must_use]
    pub fn is_valid(&self, now: u64) -> bool {
        now < self.received.saturating_add(self.validity)
    }

    /// Returns whether the ownership is over.
    #[must_use]
    pub fn is_over(&self, now: u64) -> bool {
        now >= self.received.saturating_add(self.end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_times_count_from_what_was_heard_last() {
        let at = |milliseconds: u64| (1000 + milliseconds) * MILLISECOND;
        let mut silence = Silence::after_acquire(at(0), 100, 1000);
        assert!(silence.is_valid(at(99)) && !silence.is_valid(at(100)));
        assert!(!silence.is_over(at(999)) && silence.is_over(at(1000)));
        silence.renew(at(500), 50 * MILLISECOND);
        let left = silence.of_commanded();
        assert_eq!(left.hold_after, Some(Duration::from_millis(50)));
        assert_eq!(left.end_after, Some(Duration::from_secs(1)));
        assert_eq!(left.since, Some(at(500)));
        assert_eq!(silence.of_other(), Validity { hold_after: None, ..left });
        assert!(silence.is_over(at(1500)));
    }
}
