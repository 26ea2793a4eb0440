//! Which Targets the server takes: the ordered tests of docs/remote-protocol.md, without the last one, which the hand
//! makes.

use crate::silence::MILLISECOND;
use sun2xp_remote_protocol::{Counts, Target};

/// Why a Target is not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rejection {
    /// It is no Target of this version, or its time `seen` is in the future.
    Malformed,
    /// It does not have the epoch in force, or does not come from the owner.
    OldEpoch,
    /// An earlier Target of this epoch had the same or a higher sequence number, or a later time.
    Replayed,
    /// It is older than its validity.
    Late,
    /// The hand does not admit it.
    Refused,
}

impl Rejection {
    /// Counts the Target that was not taken.
    pub fn count(self, counts: &mut Counts) {
        *match self {
            Self::Malformed => &mut counts.malformed,
            Self::OldEpoch => &mut counts.old_epoch,
            Self::Replayed => &mut counts.replayed,
            Self::Late => &mut counts.late,
            Self::Refused => &mut counts.refused,
        } += 1;
    }
}

/// What the server remembers of the Targets of one epoch.
#[derive(Clone, Copy, Debug, Default)]
pub struct Acceptance {
    /// The fields `sequence` and `sent` of the newest Target.
    newest: Option<(u64, u64)>,
}

/// A Target that has passed the tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fresh {
    /// The moment from which its validity counts, ns.
    pub seen: u64,
    /// Its validity, ns: at most `catch_ms` of the server.
    pub validity: u64,
}

impl Acceptance {
    /// Tests a Target that was received at `now`, ns. `owned` says whether it has the epoch in force and comes from the
    /// owner. `catch_ms` is the longest validity.
    ///
    /// # Errors
    /// Returns the first test that the Target does not pass.
    pub fn test(&mut self, target: &Target, owned: bool, now: u64, catch_ms: u32) -> Result<Fresh, Rejection> {
        let age = now.checked_sub(target.seen).ok_or(Rejection::Malformed)?;
        if !owned {
            return Err(Rejection::OldEpoch);
        }
        if self.newest.is_some_and(|(sequence, sent)| target.sequence <= sequence || target.sent < sent) {
            return Err(Rejection::Replayed);
        }
        self.newest = Some((target.sequence, target.sent));
        let validity = u64::from(target.validity_ms.min(catch_ms)) * MILLISECOND;
        match age < validity {
            true => Ok(Fresh { seen: target.seen, validity }),
            false => Err(Rejection::Late),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOW: u64 = 5_000 * MILLISECOND;

    fn target(sequence: u64, sent: u64, age_ms: u64) -> Target {
        Target { validity_ms: 100, epoch: 1, sequence, sent, seen: NOW - age_ms * MILLISECOND, parts: Vec::new() }
    }

    #[test]
    fn the_tests_have_an_order() {
        let mut acceptance = Acceptance::default();
        let future = Target { seen: NOW + 1, ..target(1, 1, 0) };
        assert_eq!(acceptance.test(&future, false, NOW, 100), Err(Rejection::Malformed));
        assert_eq!(acceptance.test(&target(9, 9, 500), false, NOW, 100), Err(Rejection::OldEpoch));
        assert!(acceptance.test(&target(1, 1, 5), true, NOW, 100).is_ok(), "only Targets of the owner count");
        assert_eq!(acceptance.test(&target(1, 1, 500), true, NOW, 100), Err(Rejection::Replayed));
        assert_eq!(acceptance.test(&target(2, 1, 500), true, NOW, 100), Err(Rejection::Late));
    }

    #[test]
    fn sequence_and_time_only_rise() {
        let mut acceptance = Acceptance::default();
        assert!(acceptance.test(&target(5, 50, 0), true, NOW, 100).is_ok());
        assert_eq!(acceptance.test(&target(5, 51, 0), true, NOW, 100), Err(Rejection::Replayed));
        assert_eq!(acceptance.test(&target(4, 60, 0), true, NOW, 100), Err(Rejection::Replayed));
        assert_eq!(acceptance.test(&target(6, 49, 0), true, NOW, 100), Err(Rejection::Replayed));
        assert!(acceptance.test(&target(6, 50, 0), true, NOW, 100).is_ok(), "several Targets may have the same time");
        assert_eq!(acceptance.test(&target(8, 70, 200), true, NOW, 100), Err(Rejection::Late));
        assert_eq!(acceptance.test(&target(7, 70, 0), true, NOW, 100), Err(Rejection::Replayed), "8 came before");
    }

    #[test]
    fn the_server_bounds_the_validity() {
        let mut acceptance = Acceptance::default();
        let long = Target { validity_ms: 60_000, ..target(1, 1, 99) };
        let fresh = acceptance.test(&long, true, NOW, 100).expect("young enough");
        assert_eq!((fresh.validity, fresh.seen), (100 * MILLISECOND, NOW - 99 * MILLISECOND));
        assert_eq!(
            acceptance.test(&Target { sequence: 2, seen: NOW - 100 * MILLISECOND, ..long }, true, NOW, 100),
            Err(Rejection::Late)
        );
        let short = Target { validity_ms: 20, ..target(3, 1, 20) };
        assert_eq!(acceptance.test(&short, true, NOW, 100), Err(Rejection::Late));
    }
}
