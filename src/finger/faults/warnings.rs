//! Warnings: conditions that do not stop a finger.

use super::Fault;

/// The newest warning. It is kept for some time after it was last noted, so that a planner that polls slowly sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Warnings {
    newest: Option<Fault>,
    /// Number of cycles until the newest warning is cleared.
    left: u32,
    given: u64,
}

impl Warnings {
    /// Notes the warning of this cycle, if there is one, and keeps it for `cycles` cycles.
    pub fn note(&mut self, warning: Option<Fault>, cycles: u32) {
        match warning {
            Some(fault) => {
                let persists = self.newest.is_some_and(|newest| newest.kind == fault.kind && newest.part == fault.part);
                self.given += u64::from(!persists);
                (self.newest, self.left) = (Some(fault), cycles);
            }
            None if self.left > 0 => self.left -= 1,
            None => self.newest = None,
        }
    }

    /// Returns the newest warning. Returns `None` after the warning has been absent for the number of cycles that
    /// [`Warnings::note`] was given.
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
    use crate::finger::FaultKind;
    use crate::model::Part;

    #[test]
    fn a_warning_stays_for_its_time_and_counts_once() {
        let mut warnings = Warnings::default();
        let warm = Some(Fault { kind: FaultKind::WarmMotor, part: Part::Motor(2), value: 85.0 });
        for _ in 0..10 {
            warnings.note(warm, 3);
        }
        assert_eq!((warnings.newest(), warnings.given()), (warm, 1));
        for _ in 0..3 {
            warnings.note(None, 3);
            assert_eq!(warnings.newest(), warm);
        }
        warnings.note(None, 3);
        assert_eq!((warnings.newest(), warnings.given()), (None, 1));
        warnings.note(warm, 3);
        assert_eq!(warnings.given(), 2);
    }
}
