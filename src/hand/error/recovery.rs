//! The reasons why a faulted finger cannot recover.

use crate::finger::FaultKind;
use crate::model::FingerNumber;
use thiserror::Error;

/// The reason why a faulted finger cannot recover.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecoveryError {
    /// The servo thread does not run, so it does not release its port.
    #[error(
        "the servo thread of finger {0} gets no processor time: reduce the load of the machine or permit \
         real-time scheduling (run sun2xp doctor), then recover the finger again"
    )]
    ServoStalled(FingerNumber),
    /// The servo thread has ended.
    #[error(
        "the servo thread of finger {0} has failed (fault {number}) and cannot be restarted: close the hand and open \
         it again",
        number = FaultKind::ServoPanic.number()
    )]
    ServoEnded(FingerNumber),
    /// The port has failed, and the configuration does not permit opening it again.
    #[error(
        "the port of finger {0} has failed and is not opened again, because the finger is simulated or \
         `finger.reconnect` is false: close the hand and open it again. With `finger.reconnect = true`, recovering a \
         finger reopens a real port"
    )]
    NotReconnected(FingerNumber),
}

impl RecoveryError {
    /// Returns the errno that describes the error best.
    #[must_use]
    pub fn errno(&self) -> i32 {
        match self {
            Self::ServoStalled(_) => libc::ETIMEDOUT,
            Self::ServoEnded(_) => libc::EIO,
            Self::NotReconnected(_) => libc::ENODEV,
        }
    }
}
