//! The motion of the set point in the servo: paths, the interpolation of set points, and their expiry.

use super::FingerServo;
use super::set_point_motion::Expiry;
use crate::control::motion::{InterpolationState, PathTable};
use crate::control::{Activity, SetPoint};
use crate::finger::events::{EventKind, Occurrence};
use crate::finger::motion_settings::{AfterExpiry, MotionSettings};
use crate::finger::sent::SentSetPoint;
use crate::finger::{Fault, FaultKind, Reference, Stage};
use crate::model::Part;

impl FingerServo {
    /// Computes when a set point expires. A path is valid until its end, and from there for the time of a set point.
    pub(super) fn begin_validity(&mut self, sent: &SentSetPoint) {
        let valid = sent.valid.or(self.adjustable.motion.valid);
        let now = self.motion.next_period;
        let mut begin = now;
        if self.motion.path.follower.is_some() {
            let path = self.mailbox.path();
            let length = path.table().pieces.last().map_or(0.0, |piece| piece.end());
            begin = begin.max(path.origin + (length / self.limits.period()).ceil() as u64);
        }
        self.motion.expiry =
            valid.map(|seconds| Expiry { sent: now, expires: begin + (seconds / self.limits.period()).ceil() as u64 });
    }

    /// Moves the set point of a finger that is a spring to its place in this period.
    pub(super) fn move_set_point(&mut self) {
        self.report.reference.period = self.motion.next_period;
        if self.report.stage != Stage::Running {
            self.motion.path.follower = None;
            return;
        }
        let period = self.motion.next_period;
        let motion = &mut self.motion;
        let set_point = &mut self.report.set_point;
        if let Some(follower) = &mut motion.path.follower {
            let path = self.mailbox.path();
            let time = period.saturating_sub(path.origin) as f64 * self.limits.period();
            let table = path.table();
            let stiffness = if motion.path.stiffness { table.stiffness } else { &[] };
            if follower.advance(&PathTable { stiffness, ..table }, time, set_point) {
                motion.rest(set_point.joints);
                let [x, y, z] = set_point.joints.into();
                self.events.write(Occurrence {
                    kind: EventKind::PathEnded,
                    part: Part::Finger,
                    values: [x, y, z, 0.0],
                });
            }
            self.activity = Activity::Follow(*set_point);
        } else if let Some(interpolation) = &self.adjustable.motion.interpolation {
            (set_point.joints, set_point.motion) = interpolation.advance(&mut motion.interpolation, &motion.target);
            self.activity = Activity::Follow(*set_point);
        } else if set_point.motion.is_some() {
            // The interpolation has been switched off.
            (set_point.joints, set_point.motion) = (motion.target, None);
            motion.interpolation = InterpolationState::at_rest(motion.target);
            self.activity = Activity::Follow(*set_point);
        }
        if let Some(expiry) = &self.motion.expiry
            && period >= expiry.expires
        {
            let age_ms = (period - expiry.sent) as f64 * self.limits.period_ms;
            self.expire(age_ms);
        }
    }

    /// Carries out the configured reaction to a set point that has expired after `age_ms`.
    fn expire(&mut self, age_ms: f64) {
        self.motion.expiry = None;
        self.events.write(Occurrence { kind: EventKind::Expired, part: Part::Finger, values: [age_ms, 0.0, 0.0, 0.0] });
        let MotionSettings { after_expiry, .. } = self.adjustable.motion;
        match after_expiry {
            AfterExpiry::Fault => self.fault(Fault::of(FaultKind::SetPointExpired, age_ms)),
            AfterExpiry::Hold(kx) => {
                let joints = self.report.cycle.joints;
                let held = SetPoint::hard_finger(joints, kx);
                self.follow(held, self.report.set_point_number);
                self.motion.rest(joints);
                // Later changes of planners start from the pose that is held.
                self.motion.expired_phase = Some(self.report.springs);
                self.report.springs += 1;
            }
        }
    }

    /// Notes the reference after the controller has run. `skipped` is the number of periods that will be skipped after
    /// this cycle.
    pub(super) fn note_reference(&mut self, skipped: u64) {
        let controller = match &self.calibration {
            Some(calibration) => &calibration.computes_with().controller,
            None => &self.adjustable.controller,
        };
        let (joints, motion) = controller.reference(&self.state, &self.report.set_point);
        self.report.reference = Reference { period: self.motion.next_period, joints, motion };
        self.motion.next_period += 1 + skipped;
    }
}
