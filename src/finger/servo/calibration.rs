//! A running calibration, and the state of the finger before it.

use crate::finger::Stage;
use crate::finger::{Adjustable, CalibrationRun};

/// A calibration. `before` is the state of the finger before the calibration. Until the routine gives its first
/// activity, the servo computes with the data of `before`, although the finger is already in another stage. Afterwards
/// `before` is none.
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
    /// Returns the data with which this cycle is computed.
    pub fn computes_with(&self) -> &Adjustable {
        self.before.as_ref().map_or(&self.run.adjustable, |before| &before.adjustable)
    }

    /// If the finger still follows set points as a spring, returns the data with which the servo computes. Otherwise
    /// returns none.
    pub fn spring(&self) -> Option<&Adjustable> {
        self.before.as_ref().filter(|before| before.stage == Stage::Running).map(|before| &before.adjustable)
    }
}
