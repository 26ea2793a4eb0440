//! The calibration of a finger, beside what the finger was before.

use crate::finger::Stage;
use crate::finger::{Adjustable, CalibrationRun};

/// A calibration, and what the finger goes on with until the routine takes over.
pub(super) struct Calibrating {
    pub run: CalibrationRun,
    pub before: Option<Before>,
}

/// What the finger was before its calibration.
pub(super) struct Before {
    pub stage: Stage,
    pub adjustable: Adjustable,
}

impl Calibrating {
    /// What this cycle is computed with.
    pub fn computes_with(&self) -> &Adjustable {
        self.before.as_ref().map_or(&self.run.adjustable, |before| &before.adjustable)
    }

    /// What the finger is a spring with, if it still is one.
    pub fn spring(&self) -> Option<&Adjustable> {
        self.before.as_ref().filter(|before| before.stage == Stage::Running).map(|before| &before.adjustable)
    }
}
