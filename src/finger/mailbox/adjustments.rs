//! Passes adjustments and gravity from planners to the servo, and corrects the last set point after an adjustment.

use super::{Mailbox, ServoEnd};
use crate::control::SetPoint;
use crate::finger::{Adjustable, Fault, Replaced, Stage};

impl Mailbox {
    /// Replaces the data that the servo computes with, unless the finger is faulted.
    ///
    /// # Errors
    /// Returns the fault if the finger is faulted. Nothing is changed in that case.
    pub fn adjust(&self, adjustable: Adjustable) -> Result<(), Fault> {
        let mut planners = self.planners.lock();
        if let Stage::Faulted(fault) = planners.reports.read().stage {
            return Err(fault);
        }
        planners.adjustments.write(adjustable);
        Ok(())
    }

    /// Replaces the last set point by `corrected`, if it is still `sent`. `replaced` is the part that differs. The
    /// correction does not come from a planner, so the validity of the last set point neither ends nor begins again.
    ///
    /// # Errors
    /// Returns the fault if the finger is faulted. Nothing is changed in that case.
    pub fn correct(&self, replaced: Replaced, sent: &SetPoint, corrected: SetPoint) -> Result<(), Fault> {
        let planners = &mut *self.planners.lock();
        planners.begin()?;
        if planners.sent.set_point == *sent {
            planners.sent.set_point = corrected;
            planners.sent.correct(replaced);
            planners.set_points.write(planners.sent);
        }
        Ok(())
    }

    /// Replaces gravity, m/s^2 in the finger's frame. A faulted finger takes the new value when it recovers.
    ///
    /// # Errors
    /// Returns the fault if the finger is faulted.
    pub fn set_gravity(&self, gravity: [f64; 3]) -> Result<(), Fault> {
        let mut planners = self.planners.lock();
        planners.gravity.write(gravity);
        match planners.reports.read().stage {
            Stage::Faulted(fault) => Err(fault),
            _ => Ok(()),
        }
    }
}

impl ServoEnd {
    /// Returns the data to compute with, if a planner has replaced it since the last call.
    pub fn new_adjustable(&mut self) -> Option<&Adjustable> {
        self.adjustments.update().then(|| self.adjustments.output_buffer())
    }

    /// Returns gravity, m/s^2 in the finger's frame.
    pub fn gravity(&mut self) -> &[f64; 3] {
        self.gravity.read()
    }
}
