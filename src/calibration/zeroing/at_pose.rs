//! Zeros the encoders in the configured pose, in which something holds the finger.

use super::encoder_zero::Reading;
use super::grip::Grip;
use super::swing::Swing;
use super::{Phase, Stepped, Zeroing, going};
use crate::calibration::findings::Findings;
use crate::calibration::instruments::Instruments;
use crate::calibration::joint_guide::JointGuide;
use crate::calibration::step::{Sample, Step};
use nalgebra::{Vector3, Vector4};
use std::ops::ControlFlow::Break;

impl Zeroing {
    /// Reads the joint angles before [`Grip`] pushes the joints. This step runs if the finger was limp when the zeroing
    /// began.
    pub(super) fn read_held(
        &mut self,
        mut guide: JointGuide,
        mut swing: Swing,
        instruments: &Instruments,
        sample: &Sample,
    ) -> Stepped {
        guide.measure(instruments, sample);
        let done = swing.step(instruments, sample, &mut guide);
        self.phase = if done {
            Phase::Try(Grip::new(guide, swing.reading.joints(instruments, &Vector4::zeros())))
        } else {
            Phase::ReadHeld { guide, swing }
        };
        going(Step::TryingPose, 0.4, guide.activity(instruments, sample))
    }

    pub(super) fn try_pose(&mut self, mut grip: Grip, instruments: &Instruments, sample: &Sample) -> Stepped {
        let (activity, done) = grip.step(instruments, sample, self.speed)?;
        self.phase =
            if done { Phase::ReadPose { grip, swing: Swing::new(instruments, self.torque) } } else { Phase::Try(grip) };
        going(Step::TryingPose, 0.6, activity)
    }

    pub(super) fn read_pose(
        &mut self,
        mut grip: Grip,
        mut swing: Swing,
        instruments: &Instruments,
        sample: &Sample,
    ) -> Stepped {
        let (activity, _) = grip.step(instruments, sample, self.speed)?;
        if !swing.step(instruments, sample, &mut grip.guide) {
            self.phase = Phase::ReadPose { grip, swing };
            return going(Step::ReadingEncoders, 0.9, activity);
        }
        let joints = swing.reading.joints(instruments, &Vector4::zeros());
        swing.reading.still()?;
        grip.returned(&joints)?;
        self.phase = Phase::RestInPose { grip, joints, reading: Reading::default() };
        going(Step::ReadingEncoders, 0.95, activity)
    }

    pub(super) fn rest_in_pose(
        &mut self,
        mut grip: Grip,
        joints: Vector3<f64>,
        mut reading: Reading,
        instruments: &Instruments,
        sample: &Sample,
    ) -> Stepped {
        let (activity, _) = grip.step(instruments, sample, self.speed)?;
        if !reading.step(instruments, sample, true) {
            self.phase = Phase::RestInPose { grip, joints, reading };
            return going(Step::ReadingEncoders, 0.97, activity);
        }
        // The instruments have already subtracted the offsets of the gauges.
        let none = Vector4::zeros();
        let at_rest = reading.joints(instruments, &none);
        // `joints` were measured during the [`Swing`], in which all tensions rise and fall together. The new zeros
        // correct the error of these angles. `reading` contributes only the common travel by which the motors have
        // wound in all tendons. Stretch is counted from the pretension, at which the finger is now, so an error of the
        // configured tendon stiffness does not change this travel.
        let too_far = joints - self.pose;
        let zeros = reading.zeros(instruments, &none, &(at_rest - too_far), self.configured);
        Ok(Break(self.findings(instruments, zeros, too_far, None)))
    }

    /// Returns the findings for a finger that was in the configured pose during `reading`.
    pub(super) fn at_pose(&self, instruments: &Instruments, reading: &Reading, offset: &Vector4<f64>) -> Findings {
        let zeros = reading.zeros(instruments, offset, &self.pose, self.configured);
        self.findings(instruments, zeros, reading.joints(instruments, offset) - self.pose, None)
    }
}
