//! A set point on its way from a planner to a servo.

use crate::control::SetPoint;
use crate::finger::{FingerReport, Validity};

/// The part of the set point that a call replaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Replaced {
    /// The joint angles, and perhaps other parts. A path ends.
    Place,
    /// The stiffness. A path that is followed no longer changes it.
    Stiffness,
    /// Neither of them.
    Other,
}

/// A set point. It is valid for one spring phase of a finger. A spring phase begins when the finger becomes a spring,
/// and ends at a fault or a calibration. Planners change parts of a set point, so they must start from the set point
/// that the servo holds. The servo replaces that set point at the beginning of a spring phase. Both sides identify the
/// phases by number.
#[derive(Clone, Copy)]
pub(super) struct SentSetPoint {
    /// Number of the spring phase, [`FingerReport::springs`].
    pub spring: u32,
    /// Number of the finger's newest group, 0 if there is none. The set point includes the values of that group, so it
    /// must not take effect before the group does.
    pub group: u64,
    /// Number of the set point, counted by the planners' end.
    pub number: u32,
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
}

impl SentSetPoint {
    /// Returns the set point that the servo holds.
    pub fn held(report: &FingerReport) -> Self {
        Self {
            spring: report.springs,
            group: 0,
            number: report.set_point_number,
            set_point: report.set_point,
            path: None,
            valid: Validity::default(),
        }
    }

    /// Prepares the next change. If the finger has become a spring since the last change, the next change starts from
    /// the set point that the servo holds.
    pub fn begin_with(&mut self, report: &FingerReport) {
        if report.springs != self.spring {
            *self = Self { group: self.group, ..Self::held(report) };
        }
    }

    /// Notes what a change replaces, and how long the set point is valid.
    pub fn replace(&mut self, replaced: Replaced, valid: Validity) {
        match (replaced, &mut self.path) {
            (Replaced::Place, path) => *path = None,
            (Replaced::Stiffness, Some(path)) => path.stiffness = false,
            (Replaced::Stiffness, None) | (Replaced::Other, _) => {}
        }
        self.valid = valid;
        self.number = self.number.wrapping_add(1);
    }
}
