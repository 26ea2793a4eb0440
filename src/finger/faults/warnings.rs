//! Warnings: conditions that do not stop a finger.

use super::{Fault, FaultKind};
use crate::model::Part;

/// Number of warnings that can alternate and still count only once each.
const TAKING_TURNS: usize = 4;

/// The warnings that were noted last. Several conditions may persist and be noted in turn.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::finger) struct RecentWarnings {
    /// Number of the cycle.
    cycle: u64,
    /// Each warning with the cycle in which it was noted last.
    last: [Option<(FaultKind, Part, u64)>; TAKING_TURNS],
}

impl RecentWarnings {
    /// Notes the warning of this cycle, if there is one. Returns whether the warning is new: it was absent for more
    /// than `cycles` cycles.
    fn note(&mut self, warning: Option<&Fault>, cycles: u32) -> bool {
        self.cycle += 1;
        let Some(&Fault { kind, part, .. }) = warning else { return false };
        let noted = |last: &Option<(FaultKind, Part, u64)>| last.map_or(0, |(.., noted)| noted);
        let same = self.last.iter().position(|last| last.is_some_and(|last| (last.0, last.1) == (kind, part)));
        let new = same.is_none_or(|place| self.cycle - noted(&self.last[place]) > u64::from(cycles) + 1);
        // A warning that is not among the last ones takes the place of the oldest.
        let place = same.or_else(|| (0..TAKING_TURNS).min_by_key(|&place| noted(&self.last[place])));
        place.into_iter().for_each(|place| self.last[place] = Some((kind, part, self.cycle)));
        new
    }
}

/// The newest warning. It is kept for some time after it was last noted, so that a planner that polls slowly sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Warnings {
    newest: Option<Fault>,
    /// Number of further cycles for which the newest warning is kept.
    left: u32,
    given: u64,
}

impl Warnings {
    /// Notes the warning of this cycle, if there is one, and keeps it for `cycles` cycles. Returns whether it is new.
    pub(in crate::finger) fn note(&mut self, recent: &mut RecentWarnings, warning: Option<Fault>, cycles: u32) -> bool {
        let new = recent.note(warning.as_ref(), cycles);
        self.given += u64::from(new);
        match warning {
            Some(fault) => (self.newest, self.left) = (Some(fault), cycles),
            None if self.left > 0 => self.left -= 1,
            None => self.newest = None,
        }
        new
    }

    /// Returns the newest warning. Returns `None` after the warning has been absent for more than the number of cycles
    /// that `Warnings::note` was given.
    pub fn newest(&self) -> Option<Fault> {
        self.newest
    }

    /// Returns the number of warnings. A warning that persists counts once.
    pub fn given(&self) -> u64 {
        self.given
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warning_stays_for_its_time_and_counts_once() {
        let (mut warnings, mut recent) = (Warnings::default(), RecentWarnings::default());
        let warm = Some(Fault { kind: FaultKind::WarmMotor, part: Part::Motor(2), value: 85.0 });
        for _ in 0..10 {
            warnings.note(&mut recent, warm, 3);
        }
        assert_eq!((warnings.newest(), warnings.given()), (warm, 1));
        for _ in 0..3 {
            warnings.note(&mut recent, None, 3);
            assert_eq!(warnings.newest(), warm);
        }
        warnings.note(&mut recent, None, 3);
        assert_eq!((warnings.newest(), warnings.given()), (None, 1));
        warnings.note(&mut recent, warm, 3);
        assert_eq!(warnings.given(), 2);
    }

    #[test]
    fn warnings_that_take_turns_count_once_each() {
        let (mut warnings, mut recent) = (Warnings::default(), RecentWarnings::default());
        let given = [FaultKind::CurrentLimit, FaultKind::JointAtStop].map(Fault::new);
        let new: Vec<bool> = (0..100).map(|cycle| warnings.note(&mut recent, Some(given[cycle % 2]), 3)).collect();
        assert_eq!((warnings.given(), new.iter().filter(|&&new| new).count()), (2, 2));
        assert_eq!(warnings.newest(), Some(given[1]));
        // If there are more warnings than places, the oldest warning is forgotten first.
        for motor in 0..5 {
            let part = Part::Motor(motor);
            assert!(warnings.note(&mut recent, Some(Fault { part, ..given[0] }), 3));
        }
        assert!(warnings.note(&mut recent, Some(given[1]), 3));
    }
}
