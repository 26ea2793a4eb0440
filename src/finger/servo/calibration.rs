//! A running calibration, and the state of the finger before it.

use crate::finger::Stage;
use crate::finger::{Adjustable, CalibrationRun};

/// A calibration, and the state of the finger before it, which is in force until the routine takes over.
pub(super) struct Calibrating {
    pub run: CalibrationRun,
    pub before: Option<Before>,
}

/// The state of a finger before its calibration.
pub(super) struct Before {
    pub stage: Stage,
    pub adjustable: Adjustable,
}

impl Calibrating {
    /// The data that this cycle is computed with.
    pub fn computes_with(&self) -> &Adjustable {
        self.before.as_ref().map_or(&self.run.adjustable, |before| &before.adjustable)
    }

    /// The data of the spring, if the finger still is one.
    pub fn spring(&self) -> Option<&Adjustable> {
        self.before.as_ref().filter(|before| before.stage == Stage::Running).map(|before| &before.adjustable)
    }
}
