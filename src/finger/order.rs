//! Orders that planners give to a finger in addition to set points.

use crate::calibration::Calibration;
use crate::finger::Adjustable;

/// An order to a finger. Orders are plain values, so that the servo neither allocates nor frees.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Debug)]
pub enum Order {
    /// No order yet.
    Nothing,
    /// Calibrate. If the calibration has moved the finger, the finger is limp afterwards, whether the calibration
    /// succeeds or not. Otherwise the finger returns to its previous stage.
    Calibrate(CalibrationRun),
    /// Restart with the newest [`Adjustable`], because the units of the controller's state may have changed.
    Restart {
        /// Whether the motors are off afterwards. Otherwise slack is taken up, as after open.
        limp: bool,
    },
}

/// A calibration, and the data that the servo computes with from the first activity of the calibration until its
/// verdict. Newer data from planners takes effect after the verdict.
#[derive(Clone, Debug)]
pub struct CalibrationRun {
    /// The routine.
    pub calibration: Calibration,
    /// The data that the servo computes with, constructed from the configuration that [`Calibration::controlled`]
    /// returns.
    pub adjustable: Adjustable,
}
