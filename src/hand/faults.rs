//! What is wrong with a finger.

use crate::finger::{Fault, FaultKind, Stage};
use crate::hand::{Hand, HandError};
use crate::model::configuration::RealTime;

/// The answer to [`Hand::fault`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingerFault {
    /// What made the finger stop; stays until the hand is opened anew.
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
        let configuration = self.configuration.read();
        let asked = configuration.hand.real_time != RealTime::Ignore
            && configuration.fingers.iter().any(|finger| finger.priority > 0);
        let refused = (asked && !self.given.scheduling).then_some(Fault::new(FaultKind::RealtimeRefused));
        let warning = report.warnings.newest().or(refused);
        Ok(FingerFault { stopped, warning, warnings: report.warnings.given() })
    }
}
