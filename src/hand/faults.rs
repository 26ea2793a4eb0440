//! The fault and the warnings of a finger.

use crate::finger::{Fault, FaultKind, Stage};
use crate::hand::{Hand, HandError};
use crate::model::FingerNumber;

/// The result of [`Hand::fault`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FingerFault {
    /// The fault that stopped the finger. It stays until the finger recovers or the hand is opened again.
    pub stopped: Option<Fault>,
    /// The newest warning of the last second. Without such a warning, it is [`FaultKind::RealtimeRefused`] if the
    /// system has refused SCHED_FIFO, and otherwise none. `warnings` does not count [`FaultKind::RealtimeRefused`].
    pub warning: Option<Fault>,
    /// Number of warnings since open. A warning that persists counts once.
    pub warnings: u64,
}

impl Hand {
    /// The fault and the warnings of finger 1, 2 or 3.
    ///
    /// # Errors
    /// Returns an error if there is no such finger.
    pub fn fault(&self, finger: i32) -> Result<FingerFault, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let report = self.dispatcher.last_report(finger)?;
        let stopped = match report.stage {
            Stage::Faulted(fault) => Some(fault),
            _ => None,
        };
        let refused = self.real_time.refused.then_some(Fault::new(FaultKind::RealtimeRefused));
        let warning = report.warnings.newest().or(refused);
        Ok(FingerFault { stopped, warning, warnings: report.warnings.given() })
    }
}
