//! What planners use of one finger.

use crate::finger::{Elements, Mailbox, Reflexes, Stage};
use crate::hand::HandError;
use crate::hand::admission::Admission;
use crate::model::FingerNumber;
use crate::realtime::RwLock;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The planners' side of one finger.
pub struct Member {
    /// Number of the finger, 1 to 3.
    pub number: FingerNumber,
    pub admission: RwLock<Admission>,
    pub mailbox: Mailbox,
    pub touch: Elements,
    pub reflexes: Reflexes,
    /// Whether a caller holds the right to calibrate the finger at present.
    pub calibrated: Arc<AtomicBool>,
}

impl Member {
    /// Returns why the finger follows no set point in this stage, which is not `Running`.
    pub fn refusal(&self, stage: Stage) -> HandError {
        let finger = self.number;
        match stage {
            Stage::Faulted(fault) => HandError::Faulted { finger, fault },
            // Between the end of a calibration and the use of its results, a finger is limp for a moment. Its set
            // points are then refused as those of a busy finger.
            Stage::Limp if !self.calibrated.load(Ordering::Acquire) => HandError::Limp(finger),
            _ => HandError::Busy(finger),
        }
    }
}
