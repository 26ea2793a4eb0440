//! What planners use of one finger.

use crate::finger::{Elements, Mailbox, Reflexes};
use crate::hand::admission::Admission;
use crate::model::FingerNumber;
use crate::realtime::RwLock;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

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
