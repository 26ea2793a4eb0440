//! Runs a calibration in the servo: the start, the steps of the routine, and the stage of the finger afterwards.

use super::FingerServo;
use super::calibration::{Before, Calibrating};
use crate::board::protocol::Status;
use crate::calibration::{Sample, Verdict};
use crate::control::Activity;
use crate::finger::Stage;
use crate::finger::{Adjustable, CalibrationRun};

impl FingerServo {
    pub(super) fn begin_calibration(&mut self, run: CalibrationRun) {
        let before = Before { stage: self.report.stage, adjustable: self.adjustable.clone() };
        self.calibration = Some(Calibrating { run, before: Some(before) });
        self.report.calibration = None;
        self.end_motion();
        self.enter(Stage::Calibrating);
    }

    /// Ends the path or the interpolation of a finger that follows set points. A calibration does not continue this
    /// motion, so no part of the motion may remain in the commands of the calibration or in the set point afterwards.
    fn end_motion(&mut self) {
        if self.report.stage == Stage::Running {
            self.report.set_point.motion = None;
            self.motion.rest(self.report.set_point.joints);
            self.activity = Activity::Follow(self.report.set_point);
        }
    }

    /// Runs one step of the calibration, if there is one and a reply has arrived, and sets the finger's activity.
    /// Returns the [`Adjustable`] of the previous cycle if the servo computes this cycle with another one. This happens
    /// in two cases: the calibration gives its first activity, or the calibration ends without an activity after
    /// planners have replaced the `Adjustable` of the finger.
    pub(super) fn calibrate(&mut self) -> Option<Adjustable> {
        let Calibrating { run, before } = self.calibration.as_mut()?;
        if !self.answered {
            return None;
        }
        let zero_valid = self.status.has(Status::ZERO_VALID);
        let sample = Sample { feedback: &self.feedback, report: &self.report.cycle, zero_valid };
        let (activity, verdict) = run.calibration.cycle(&sample);
        self.report.calibration = Some(verdict);
        let mut previous = None;
        if let Some(activity) = activity {
            self.activity = activity;
            previous = before.take().map(|before| before.adjustable);
        }
        if !matches!(verdict, Verdict::InProgress(_)) {
            let untouched = before.take();
            self.calibration = None;
            match untouched {
                Some(before) => return self.go_on_from(before),
                None => self.go_limp(),
            }
        }
        previous
    }

    /// Enters the stage that the finger had before a calibration that gave no activity. If planners have replaced the
    /// [`Adjustable`] of the finger during the calibration, returns the previous one.
    fn go_on_from(&mut self, before: Before) -> Option<Adjustable> {
        // Set points that planners sent meanwhile had no effect, so the next change of a set point must not start from
        // one of them. In a new spring phase (`FingerReport::springs`), the next change starts from the set point that
        // the servo holds.
        self.report.springs += u32::from(before.stage == Stage::Running);
        self.report.expired_phase = None;
        self.motion.renewal = None;
        self.enter(before.stage);
        // A path that was sent together with the order to calibrate has not begun, and must not begin now.
        self.end_motion();
        (before.adjustable.number != self.adjustable.number).then_some(before.adjustable)
    }
}
