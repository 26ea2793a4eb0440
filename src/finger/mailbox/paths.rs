//! Paths on their way to the servo.

use super::last_path::LastPath;
use super::{Mailbox, PlannersEnd, ServoEnd};
use crate::control::SetPoint;
use crate::control::motion::{PathExtent, PathTable};
use crate::finger::path_buffer::PathBuffer;
use crate::finger::sent::SentPath;
use crate::finger::{Fault, Replaced, Validity};

impl Mailbox {
    /// Sends a path that begins in period `origin`. `change` gets a copy of the set point that was sent last, moves it
    /// to the end of the path, and returns the extent of the path. If the path changes the stiffness, the copy has the
    /// stiffness with which the path begins. `spring` is the number of the spring phase
    /// ([`FingerReport::springs`](crate::finger::FingerReport::springs)) for which the path was computed. Returns the
    /// number of the path, or none if another spring phase has begun.
    ///
    /// # Errors
    /// Returns the fault if the finger is faulted. If `change` refuses the set point, the inner result is its error.
    /// Nothing is sent in these cases.
    pub fn send_path<E>(
        &self,
        (spring, origin, valid): (u32, u64, Validity),
        path: &PathTable,
        change: impl FnOnce(&mut SetPoint) -> Result<PathExtent, E>,
    ) -> Result<Result<Option<u32>, E>, Fault> {
        let planners = &mut *self.planners.lock();
        planners.begin()?;
        if planners.sent.spring != spring {
            return Ok(Ok(None));
        }
        let stiffness = !path.stiffness.is_empty();
        let stiffens = planners.path_ahead().is_some_and(|ahead| ahead.stiffest.is_some());
        let present = planners.reports.read().set_point.stiffness;
        // The servo may not have taken a stiffness that was sent just before. It then takes only the newer set point of
        // the path. If an earlier path changes the stiffness, this one begins with the stiffness that is in force.
        let begin = (!stiffens).then_some(planners.sent.set_point.stiffness);
        let next = planners.set_points.input_buffer_mut();
        *next = planners.sent;
        if stiffness && stiffens {
            // The set point that was sent has the stiffness of the end of the previous path.
            next.set_point.stiffness = present;
        }
        let extent = match change(&mut next.set_point) {
            Ok(extent) => extent,
            Err(refusal) => return Ok(Err(refusal)),
        };
        let number = planners.path.number.wrapping_add(1).max(1);
        let length = path.pieces.last().map_or(0.0, |piece| piece.end());
        next.path = Some(SentPath { number, stiffness, origin, length });
        next.valid = valid;
        next.number = next.number.wrapping_add(1);
        next.planned = next.number;
        planners.path = LastPath { number, set_point: next.number, extent };
        planners.sent = *next;
        // The path is published before the set point, so that a servo that has the set point also has the path.
        planners.paths.input_buffer_mut().fill(number, origin, begin, path);
        planners.paths.publish();
        planners.set_points.publish();
        Ok(Ok(Some(number)))
    }

    /// Returns the extent of the path that leads to the set point that was sent last. Returns none if there is no path,
    /// or if it has ended.
    pub fn path_ahead(&self) -> Option<PathExtent> {
        let planners = &mut *self.planners.lock();
        planners.sent.begin_with(planners.reports.read());
        planners.path_ahead()
    }
}

impl PlannersEnd {
    /// Like [`Mailbox::path_ahead`], after the set point that was sent last has been brought up to date.
    fn path_ahead(&mut self) -> Option<PathExtent> {
        let path = self.sent.path?;
        let report = self.reports.read();
        let taken = report.set_point_number.wrapping_sub(self.path.set_point).cast_signed() >= 0;
        // The set point moves until the path has ended.
        if taken && report.set_point.motion.is_none() {
            return None;
        }
        let PathExtent { lowest, highest, stiffest } = self.path.extent;
        // A stiffness that was sent later has ended the change of the stiffness along the path.
        Some(PathExtent { lowest, highest, stiffest: stiffest.filter(|_| path.stiffness) })
    }

    /// Returns the path that the finger follows after a change that replaces `replaced`, if the path may still change
    /// the stiffness.
    pub(super) fn path_kept_by(&mut self, replaced: Replaced) -> Option<PathExtent> {
        match replaced {
            Replaced::Other => self.path_ahead(),
            Replaced::Place | Replaced::Stiffness => None,
        }
    }
}

impl ServoEnd {
    /// Takes the newest path.
    pub fn take_path(&mut self) -> &PathBuffer {
        self.paths.read()
    }

    /// Returns the path that was taken last.
    pub fn path(&mut self) -> &PathBuffer {
        self.paths.output_buffer()
    }
}
