//! What a servo reports of its finger.

use crate::calibration::Verdict;
use crate::control::{Report, SetPoint};
use crate::finger::{Losses, Stage, Warnings};

/// What a servo tells of its finger, each cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingerReport {
    /// Where the finger is between open and close.
    pub stage: Stage,
    /// The set point in force.
    pub set_point: SetPoint,
    /// How often it has become a spring that holds the pose it was found in: at open, after a fault, after a calibration. What was
    /// sent before is gone.
    pub springs: u32,
    /// What the last cycle found and decided.
    pub cycle: Report,
    /// Number of the controller that planners have handed over last and the servo has taken: it is computed with, or will be after a
    /// calibration.
    pub controller: u32,
    /// How many orders have been taken.
    pub orders: u32,
    /// What became of the last calibration, if there was one.
    pub calibration: Option<Verdict>,
    /// Since open.
    pub losses: Losses,
    /// How often it has gone on after a fault.
    pub recoveries: u32,
    /// What the finger is warned of.
    pub warnings: Warnings,
    /// When the first cycle began, ns of the monotonic clock.
    pub first: u64,
    /// When the last cycle began, ns of the monotonic clock.
    pub last: u64,
}
