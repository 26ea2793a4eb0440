//! Paths on their way to the servo.

use super::last_path::{self, LastPath};
use super::{Mailbox, PlannersEnd, SentSetPoint, ServoEnd};
use crate::control::SetPoint;
use crate::control::motion::{PathExtent, PathTable};
use crate::finger::path_buffer::PathBuffer;
use crate::finger::sent::SentPath;
use crate::finger::{Fault, Replaced, Validity};
use nalgebra::Matrix6;
use std::sync::MutexGuard;

/// A path of one finger, before it is sent. While this value exists, no other planner can change the finger's set
/// point. Dropping this value changes nothing.
pub struct PreparedPath<'a> {
    planners: MutexGuard<'a, PlannersEnd>,
    next: SentSetPoint,
    last: LastPath,
    origin: u64,
    path: PathTable<'a>,
}

impl Mailbox {
    /// Sends a path. `when` holds the number of the spring phase
    /// ([`FingerReport::springs`](crate::finger::FingerReport::springs)) for which the path was computed, the period in
    /// which the path begins, and the validity of the path. `change` gets a copy of the set point that was sent last,
    /// moves it to the end of the path, and returns the extent of the path. If the path changes the stiffness, the copy
    /// has the stiffness with which the path begins. Returns the number of the path, or none if another spring phase
    /// has begun.
    ///
    /// # Errors
    /// Returns the fault if the finger is faulted. If `change` refuses the set point, the inner result is its error.
    /// Nothing is sent in these cases.
    pub fn send_path<E>(
        &self,
        when: (u32, u64, Validity),
        path: &PathTable,
        change: impl FnOnce(&mut SetPoint) -> Result<PathExtent, E>,
    ) -> Result<Result<Option<u32>, E>, Fault> {
        let no_command = None::<(Replaced, fn(&mut SetPoint) -> Result<(), E>)>;
        let prepared = self.prepare_path(when, path, no_command, change)?;
        Ok(prepared.map(|prepared| prepared.map(PreparedPath::send)))
    }

    /// Prepares a path for [`PreparedPath::send`]. `spring`, `origin` and `valid` are the parts of the parameter `when`
    /// of [`Mailbox::send_path`], and `change` is the same as there. `command` changes the set point before the path
    /// begins, as [`Mailbox::try_send`] does, and says which part it replaces. A caller that prepares several fingers
    /// must do this in the order of their numbers, as for [`Mailbox::prepare`].
    ///
    /// # Errors
    /// Returns the fault if the finger is faulted. If `command` or `change` refuses the set point, the inner result is
    /// its error.
    pub fn prepare_path<'a, E>(
        &'a self,
        (spring, origin, valid): (u32, u64, Validity),
        path: &PathTable<'a>,
        command: Option<(Replaced, impl FnOnce(&mut SetPoint) -> Result<(), E>)>,
        change: impl FnOnce(&mut SetPoint) -> Result<PathExtent, E>,
    ) -> Result<Result<Option<PreparedPath<'a>>, E>, Fault> {
        let mut planners = self.planners.lock();
        planners.begin()?;
        if planners.sent.spring != spring {
            return Ok(Ok(None));
        }
        let mut next = planners.sent;
        if let Some((replaced, command)) = command {
            let path_kept = planners.path_kept_by(replaced);
            if let Err(refusal) = last_path::change_along(path_kept, &mut next.set_point, command) {
                return Ok(Err(refusal));
            }
            next.replace(replaced, valid);
        }
        let stiffness = !path.stiffness.is_empty();
        let (first, begin) = planners.begin_of_stiffness(&next);
        if stiffness {
            next.set_point.stiffness = first;
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
        let last = LastPath { number, set_point: next.number, begin, extent };
        Ok(Ok(Some(PreparedPath { planners, next, last, origin, path: *path })))
    }

    /// Returns the extent of the path that leads to the set point that was sent last. Returns none if there is no path,
    /// or if it has ended.
    pub fn path_ahead(&self) -> Option<PathExtent> {
        let planners = &mut *self.planners.lock();
        planners.sent.begin_with(planners.reports.read());
        planners.path_ahead()
    }
}

impl PreparedPath<'_> {
    /// Sends the path, and returns its number.
    pub fn send(self) -> u32 {
        let Self { mut planners, next, last, origin, path } = self;
        let planners = &mut *planners;
        let LastPath { number, begin, .. } = last;
        (planners.sent, planners.path) = (next, last);
        // The path is published before the set point, so that a servo that has the set point also has the path.
        planners.paths.input_buffer_mut().fill(number, origin, begin, &path);
        planners.paths.publish();
        planners.set_points.write(next);
        number
    }
}

impl PlannersEnd {
    /// Does the same as [`Mailbox::path_ahead`], but does not update `sent` to the present spring phase. The caller
    /// must have called [`SentSetPoint::begin_with`].
    fn path_ahead(&mut self) -> Option<PathExtent> {
        self.extent_ahead(self.sent.path)
    }

    /// Returns the extent of the path that leads to a set point which has `path`. Returns none if there is no path, or
    /// if it has ended.
    fn extent_ahead(&mut self, path: Option<SentPath>) -> Option<PathExtent> {
        let path = path?;
        // The set point moves until the path has ended.
        if self.is_path_taken() && self.reports.read().set_point.motion.is_none() {
            return None;
        }
        let PathExtent { lowest, highest, stiffest } = self.path.extent;
        // If a stiffness was sent after the path, `path.stiffness` is false: the path no longer changes the stiffness.
        Some(PathExtent { lowest, highest, stiffest: stiffest.filter(|_| path.stiffness) })
    }

    /// Returns whether the servo follows the path that was sent last, or has followed it.
    fn is_path_taken(&mut self) -> bool {
        self.reports.read().set_point_number.wrapping_sub(self.path.set_point).cast_signed() >= 0
    }

    /// Returns the stiffness with which a path that comes after `sent` begins, and the stiffness that the path must
    /// bring to the servo. The second value is none if the stiffness in force is changing along an earlier path,
    /// because the servo then begins with the stiffness in force. Otherwise both values are the same. If the path did
    /// not bring this stiffness, a stiffness that was sent just before the path would never come into force, because
    /// the servo takes only the newest set point. The path would then begin with an older stiffness, for which the
    /// damping was not checked.
    fn begin_of_stiffness(&mut self, sent: &SentSetPoint) -> (Matrix6<f64>, Option<Matrix6<f64>>) {
        let changing = sent.path.is_some_and(|path| path.stiffness) && self.extent_ahead(sent.path).is_some();
        // While an earlier path changes the stiffness, `sent` already has the stiffness of the end of that path.
        let begin = if !changing {
            Some(sent.set_point.stiffness)
        } else if self.is_path_taken() {
            None
        } else {
            self.path.begin
        };
        (begin.unwrap_or_else(|| self.reports.read().set_point.stiffness), begin)
    }

    /// Returns the extent of the path that [`last_path::change_along`] takes into account when a command replaces the
    /// part `replaced` of the set point. Returns none for a new place, because it ends the path. Returns none for a new
    /// stiffness too, because the path then no longer changes the stiffness.
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
