//! Zeros the encoders in the configured pose, in which something holds the finger.

use super::encoder_zero::Reading;
use super::grip::Grip;
use super::{Phase, Stepped, Zeroing, going};
use crate::calibration::findings::Findings;
use crate::calibration::instruments::Instruments;
use crate::calibration::step::{Sample, Step};
use nalgebra::Vector4;
use std::ops::ControlFlow::Break;

impl Zeroing {
    pub(super) fn try_pose(&mut self, mut grip: Grip, instruments: &Instruments, sample: &Sample) -> Stepped {
        let (activity, done) = grip.step(instruments, sample, self.speed)?;
        self.phase = if done { Phase::ReadPose { grip, reading: Reading::default() } } else { Phase::Try(grip) };
        going(Step::TryingPose, 0.6, activity)
    }

    pub(super) fn read_pose(
        &mut self,
        mut grip: Grip,
        mut reading: Reading,
        instruments: &Instruments,
        sample: &Sample,
    ) -> Stepped {
        let (activity, _) = grip.step(instruments, sample, self.speed)?;
        if !reading.step(instruments, sample) {
            self.phase = Phase::ReadPose { grip, reading };
            return going(Step::ReadingEncoders, 0.9, activity);
        }
        // The instruments have already subtracted the offsets.
        let none = Vector4::zeros();
        reading.still()?;
        grip.returned(&reading.joints(instruments, &none))?;
        Ok(Break(self.at_pose(instruments, &reading, &none)))
    }

    /// Returns the findings for a finger that was in the configured pose during `reading`.
    pub(super) fn at_pose(&self, instruments: &Instruments, reading: &Reading, offset: &Vector4<f64>) -> Findings {
        let zeros = reading.zeros(instruments, offset, &self.pose, self.configured);
        self.findings(instruments, zeros, reading.joints(instruments, offset) - self.pose, None)
    }
}
