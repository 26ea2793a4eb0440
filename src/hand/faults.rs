//! What is wrong with a finger.

use crate::finger::{Fault, FaultKind, Stage};
use crate::hand::{Hand, HandError};

/// The answer to [`Hand::fault`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingerFault {
    /// What made the finger stop; stays until it recovers, or the hand is opened anew.
    pub stopped: Option<Fault>,
    /// What the finger is warned of, up to a second ago.
    pub warning: Option<Fault>,
    /// How many warnings have been given since open; one that goes on counts once.
    pub warnings: u64,
}

impl Hand {
    /// What is wrong with finger 1, 2 or 3.
    ///
    /// # Errors
    /// No such finger.
    pub fn fault(&self, finger: i32) -> Result<FingerFault, HandError> {
        let report = self.report(finger)?;
        let stopped = match report.stage {
            Stage::Faulted(fault) => Some(fault),
            _ => None,
        };
        let refused = self.given.refused.then_some(Fault::new(FaultKind::RealtimeRefused));
        let warning = report.warnings.newest().or(refused);
        Ok(FingerFault { stopped, warning, warnings: report.warnings.given() })
    }
}
