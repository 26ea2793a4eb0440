//! The motion of the set point in the servo: paths, the interpolation of set points, and their expiry.

use super::FingerServo;
use super::set_point_motion::{Expiry, NEVER};
use crate::control::motion::{InterpolationState, PathTable};
use crate::control::{Activity, SetPoint, spatial};
use crate::finger::events::{EventKind, Occurrence};
use crate::finger::motion_settings::{AfterExpiry, MotionSettings};
use crate::finger::sent::SentSetPoint;
use crate::finger::{Fault, FaultKind, Reference, Stage, Validity};
use crate::model::Part;

impl FingerServo {
    /// Computes when a set point expires. A path is valid until its end, and then for the time for which a set point is
    /// valid. This also applies to a path that the finger does not follow because of the inhibition after a reflex.
    pub(super) fn begin_validity(&mut self, sent: &SentSetPoint) {
        let end = sent.path.as_ref().map_or(0, |path| path.end(self.limits.period()));
        let begin = end.max(self.motion.next_period);
        self.set_validity(begin, &sent.valid);
        // The renewal may have come before its set point.
        if let Some(renewal) = self.motion.renewal
            && renewal.number == sent.planned
        {
            self.set_validity(self.motion.next_period, &renewal.validity);
        }
    }

    /// Takes a renewed validity, if there is one. The renewed validity begins at once, even if a path has not ended.
    pub(super) fn renew_validity(&mut self) {
        let Some(renewal) = self.mailbox.new_renewal() else { return };
        let ahead = renewal.number.wrapping_sub(self.report.set_point_number).cast_signed();
        let newest = ahead >= 0 || self.motion.is_planned_last(renewal.number);
        if matches!(self.report.stage, Stage::Running | Stage::Calibrating) && newest {
            self.motion.renewal = Some(renewal);
            self.set_validity(self.motion.next_period, &renewal.validity);
        }
    }

    /// Sets the validity, which begins in the period `begin`. The time that has already passed since `validity.since`
    /// is deducted from it. A new validity does not revive a set point that has expired: a finger that already holds
    /// its pose for this reason continues to hold it.
    fn set_validity(&mut self, begin: u64, validity: &Validity) {
        let (hold, end) = self.adjustable.motion.times(validity);
        let past = validity.since.map_or(0.0, |since| self.report.last.saturating_sub(since) as f64 * 1e-9);
        // The conversion saturates, so an infinite time becomes a period that does not come, and a negative time
        // becomes 0.
        let after = |seconds: f64| begin.saturating_add(((seconds - past) / self.limits.period()).ceil() as u64);
        let expires = if self.report.expired { NEVER } else { after(hold) };
        let expiry = Expiry { sent: self.motion.next_period, expires, ends: after(end) };
        self.motion.expiry = (expiry.expires.min(expiry.ends) != NEVER).then_some(expiry);
    }

    /// Moves the set point of a finger in the stage `Running` to its place in this period.
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
            && period >= expiry.expires.min(expiry.ends)
        {
            let age_ms = (period - expiry.sent) as f64 * self.limits.period_ms;
            let ends = period >= expiry.ends;
            self.expire(age_ms, ends);
        }
    }

    /// Ends the change of the stiffness along a path, because the bound of Kx was lowered. The Kx of the path's end,
    /// reduced to the new bound, takes effect at once. The values before the end were checked only against the previous
    /// bound.
    pub(super) fn end_stiffness_of_path(&mut self) {
        if self.motion.path.follower.is_some()
            && std::mem::take(&mut self.motion.path.stiffness)
            && let Some(last) = self.mailbox.path().table().stiffness.last()
        {
            self.report.set_point.stiffness = self.adjustable.reactions.stiffness(&spatial(&last.kx));
        }
    }

    /// Carries out the configured reaction to a set point that has expired at the age `age_ms`. If `ends` is true, the
    /// end time of the validity has passed too, and the finger faults, whatever the configured reaction is.
    fn expire(&mut self, age_ms: f64, ends: bool) {
        if !self.report.expired {
            let values = [age_ms, 0.0, 0.0, 0.0];
            self.events.write(Occurrence { kind: EventKind::Expired, part: Part::Finger, values });
        }
        let MotionSettings { after_expiry, .. } = self.adjustable.motion;
        match after_expiry {
            _ if ends => self.fault(Fault::of(FaultKind::SetPointExpired, age_ms)),
            AfterExpiry::Fault => self.fault(Fault::of(FaultKind::SetPointExpired, age_ms)),
            AfterExpiry::Hold(kx) => {
                self.report.expired = true;
                self.motion.expiry.iter_mut().for_each(|expiry| expiry.expires = NEVER);
                let joints = self.report.cycle.joints;
                let held = SetPoint::hard_finger(joints, kx);
                self.follow(held, self.report.set_point_number);
                self.motion.rest(joints);
                // The changes that planners send later start from the pose that is held.
                self.report.expired_phase = Some(self.report.springs);
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
