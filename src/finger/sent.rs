//! A set point on its way from a planner to a servo.

use crate::control::SetPoint;
use crate::finger::{FingerReport, Validity};

/// The part of the set point that a call replaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Replaced {
    /// The joint angles, and perhaps other parts. A path in progress ends.
    Place,
    /// The stiffness. A path in progress continues, but no longer changes the stiffness.
    Stiffness,
    /// Neither the joint angles nor the stiffness.
    Other,
}

/// A set point. It is valid for one spring phase of a finger. A spring phase is a time in which the finger follows set
/// points without an interruption ([`FingerReport::springs`] lists what begins a new phase). Planners change parts of a
/// set point, so they must start from the set point that the servo holds. The servo may replace that set point at the
/// beginning of a spring phase. Both sides identify the phases by number.
#[derive(Clone, Copy)]
pub(super) struct SentSetPoint {
    /// Number of the spring phase, [`FingerReport::springs`].
    pub spring: u32,
    /// Number of the finger's newest group, 0 if there is none. The set point includes the values of that group, so it
    /// must not take effect before the group does.
    pub group: u64,
    /// Number of the set point, counted by the planners' end of the mailbox.
    pub number: u32,
    /// Number of the last set point that a planner has sent, to which `valid` belongs. It is lower than `number` if the
    /// library has corrected that set point since.
    pub planned: u32,
    /// The set point. If there is a path, it holds the end of the path.
    pub set_point: SetPoint,
    /// The path that leads to the set point.
    pub path: Option<SentPath>,
    /// How long the set point is valid.
    pub valid: Validity,
}

/// A path that a servo follows.
#[derive(Clone, Copy)]
pub(super) struct SentPath {
    /// Number of the path.
    pub number: u32,
    /// Whether the path changes the stiffness.
    pub stiffness: bool,
    /// The period in which the path begins.
    pub origin: u64,
    /// Length of the path, s.
    pub length: f64,
}

impl SentPath {
    /// Returns the period in which the path ends. `period` is the length of a period, s.
    pub fn end(&self, period: f64) -> u64 {
        self.origin + (self.length / period).ceil() as u64
    }
}

impl SentSetPoint {
    /// Returns the set point that the servo holds.
    pub fn held(report: &FingerReport) -> Self {
        Self {
            spring: report.springs,
            group: 0,
            number: report.set_point_number,
            planned: report.set_point_number,
            set_point: report.set_point,
            path: None,
            valid: Validity::default(),
        }
    }

    /// Prepares the next change. If a new spring phase has begun since the last change, the next change starts from the
    /// set point that the servo holds. There is one exception: if the last change was sent while an earlier set point
    /// expired, the servo will still follow the last change, so the next change starts from the last change.
    pub fn begin_with(&mut self, report: &FingerReport) {
        if report.springs == self.spring {
            return;
        }
        // A correction by the library does not raise `planned`. If only a correction of the expired set point was sent,
        // `ahead` is not positive, and the servo discards the correction.
        let ahead = self.planned.wrapping_sub(report.set_point_number).cast_signed();
        if report.expired_phase == Some(self.spring) && ahead > 0 {
            self.spring = report.springs;
        } else {
            *self = Self { group: self.group, ..Self::held(report) };
        }
    }

    /// Notes what the change of a planner replaces, and how long the set point is valid.
    pub fn replace(&mut self, replaced: Replaced, valid: Validity) {
        self.correct(replaced);
        self.valid = valid;
        self.planned = self.number;
    }

    /// Notes what a correction by the library replaces. The library may have to correct the last set point when the
    /// limits of the finger change.
    pub fn correct(&mut self, replaced: Replaced) {
        match (replaced, &mut self.path) {
            (Replaced::Place, path) => *path = None,
            (Replaced::Stiffness, Some(path)) => path.stiffness = false,
            (Replaced::Stiffness, None) | (Replaced::Other, _) => {}
        }
        self.number = self.number.wrapping_add(1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};

    fn at(angle: f64) -> SetPoint {
        SetPoint::hard_finger(Vector3::from_element(angle), Matrix3::identity())
    }

    /// The servo accepts the set point in its next cycle, because the phase for which it was sent has just ended with
    /// the expiry of the previous set point.
    #[test]
    fn a_set_point_that_was_sent_while_its_predecessor_expired_is_kept() {
        let mut report = FingerReport::opening(at(0.1));
        let mut sent = SentSetPoint::held(&report);
        sent.set_point = at(0.7);
        sent.replace(Replaced::Place, Validity::default());
        (report.springs, report.expired_phase) = (1, Some(0));
        sent.begin_with(&report);
        assert_eq!((sent.spring, sent.number, sent.set_point), (1, 1, at(0.7)));
    }

    #[test]
    fn a_set_point_that_has_expired_itself_is_replaced_by_the_held_one() {
        let mut report = FingerReport::opening(at(0.1));
        let mut sent = SentSetPoint::held(&report);
        sent.set_point = at(0.7);
        sent.replace(Replaced::Place, Validity::default());
        (report.set_point_number, report.springs, report.expired_phase) = (1, 1, Some(0));
        sent.begin_with(&report);
        assert_eq!((sent.spring, sent.number, sent.set_point), (1, 1, at(0.1)));
    }

    /// The servo discards the correction, because the set point that it corrects has expired.
    #[test]
    fn a_correction_that_was_sent_while_its_set_point_expired_is_replaced_by_the_held_one() {
        let mut report = FingerReport::opening(at(0.1));
        let mut sent = SentSetPoint::held(&report);
        sent.replace(Replaced::Place, Validity::default());
        sent.set_point = at(0.7);
        sent.correct(Replaced::Place);
        (report.set_point_number, report.springs, report.expired_phase) = (1, 1, Some(0));
        sent.begin_with(&report);
        assert_eq!((sent.spring, sent.number, sent.set_point), (1, 1, at(0.1)));
    }
}
