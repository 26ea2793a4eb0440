//! Renews the time for which a set point is valid, without sending a new set point.

use super::{Mailbox, ServoEnd};
use crate::finger::validity::Renewal;
use crate::finger::{Fault, Validity};

impl Mailbox {
    /// Renews the validity of the set point that was sent last.
    ///
    /// # Errors
    /// Returns the fault if the finger is faulted. Nothing is sent in that case.
    pub fn keep_valid(&self, validity: Validity) -> Result<(), Fault> {
        let planners = &mut *self.planners.lock();
        planners.begin()?;
        planners.renewals.write(Renewal { number: planners.sent.planned, validity });
        Ok(())
    }
}

impl ServoEnd {
    /// Returns the newest renewal, if one has arrived since the last call. A renewal may arrive before its set point.
    pub fn new_renewal(&mut self) -> Option<Renewal> {
        self.renewals.update().then(|| *self.renewals.output_buffer())
    }
}
