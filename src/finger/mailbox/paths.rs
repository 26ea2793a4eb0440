//! Paths on their way to the servo.

use super::{Mailbox, ServoEnd};
use crate::control::SetPoint;
use crate::control::motion::PathTable;
use crate::finger::path_buffer::PathBuffer;
use crate::finger::sent::SentPath;
use crate::finger::{Fault, Validity};

impl Mailbox {
    /// Sends a path that begins in period `origin`. `change` gets a copy of the set point that was sent last, and moves
    /// it to the end of the path. `spring` is the number of the spring phase
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
        change: impl FnOnce(&mut SetPoint) -> Result<(), E>,
    ) -> Result<Result<Option<u32>, E>, Fault> {
        let planners = &mut *self.planners.lock();
        planners.begin()?;
        if planners.sent.spring != spring {
            return Ok(Ok(None));
        }
        let next = planners.set_points.input_buffer_mut();
        *next = planners.sent;
        if let Err(refusal) = change(&mut next.set_point) {
            return Ok(Err(refusal));
        }
        let number = planners.path.wrapping_add(1).max(1);
        let length = path.pieces.last().map_or(0.0, |piece| piece.end());
        next.path = Some(SentPath { number, stiffness: !path.stiffness.is_empty(), origin, length });
        next.valid = valid;
        next.number = next.number.wrapping_add(1);
        next.planned = next.number;
        (planners.path, planners.sent) = (number, *next);
        // The path is published before the set point, so that a servo that has the set point also has the path.
        planners.paths.input_buffer_mut().fill(number, origin, path);
        planners.paths.publish();
        planners.set_points.publish();
        Ok(Ok(Some(number)))
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
