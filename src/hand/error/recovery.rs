//! Why a faulted finger cannot recover.

use crate::finger::FaultKind;
use thiserror::Error;

/// A faulted finger that cannot recover.
#[derive(Debug, Error)]
pub enum RecoveryError {
    /// A faulted finger whose port another one uses.
    #[error(
        "finger {finger} shares its port with finger {other}, which runs, and fingers on one port recover together: \
         call StopHand, then RecoverHand"
    )]
    PortInUse {
        /// 1 to 3.
        finger: i32,
        /// The finger that runs.
        other: i32,
    },
    /// A servo that does not run, so that it does not lend its port.
    #[error(
        "the servo thread of finger {0} gets no processor time: reduce the load of the machine or permit real time \
         (README), then call RecoverHand again"
    )]
    ServoStalled(i32),
    /// A faulted finger whose servo thread has ended.
    #[error(
        "the servo thread of finger {0} has failed (fault {number}) and cannot be started again: call CloseHand, then \
         OpenHand",
        number = FaultKind::ServoPanic.number()
    )]
    ServoEnded(i32),
    /// A port that has failed, and is not to be opened again.
    #[error(
        "the port of finger {0} has failed and is not opened again: call CloseHand, then OpenHand. With \
         `finger.reconnect = true` RecoverHand opens a real port again"
    )]
    NotReconnected(i32),
}

impl RecoveryError {
    /// The nearest errno.
    pub fn errno(&self) -> i32 {
        match self {
            Self::PortInUse { .. } => libc::EBUSY,
            Self::ServoStalled(_) => libc::ETIMEDOUT,
            Self::ServoEnded(_) => libc::EIO,
            Self::NotReconnected(_) => libc::ENODEV,
        }
    }
}
