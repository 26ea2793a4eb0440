//! What planners ask of a finger besides set points.

use crate::calibration::Calibration;
use crate::finger::Adjustable;

/// What a finger is asked for besides set points. Plain values: the servo neither allocates nor frees.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Debug)]
pub enum Order {
    /// Nothing, as in the beginning.
    Nothing,
    /// To be calibrated; the finger is limp afterwards, whatever comes of it.
    Calibrate(CalibrationRun),
    /// To begin anew with what it was handed last to compute with: what its state is measured in may have changed.
    Restart {
        /// With the motors off; else slack is taken up, as after open.
        limp: bool,
    },
}

/// A calibration with what the servo computes with until its verdict. What it was handed besides is kept for
/// afterwards.
#[derive(Clone, Debug)]
pub struct CalibrationRun {
    /// The routine.
    pub calibration: Calibration,
    /// Made for [`Calibration::controlled`].
    pub adjustable: Adjustable,
}
