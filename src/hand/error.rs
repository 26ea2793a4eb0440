//! Why a call was refused, and what to do about it.

mod configuration;
mod errno;
mod kind;
mod recovery;
mod set_point;

pub use configuration::ConfigurationError;
pub(crate) use kind::ErrorKind;
pub use recovery::RecoveryError;
pub use set_point::SetPointError;

use crate::board::LinkError;
use crate::calibration::Obstacle;
use crate::finger::{Fault, FaultKind};
use crate::hand::missing_permissions::MissingPermission;
use crate::model::{ShownPath, UnusableConfiguration};
use crate::realtime::with_remedy;
use std::path::PathBuf;
use thiserror::Error;

/// A refused call: nothing was changed. The text names the cause and the remedy.
#[derive(Debug, Error)]
pub enum HandError {
    /// Fingers are 1, 2 and 3.
    #[error("there is no finger {0}: fingers are 1, 2 and 3")]
    NoSuchFinger(i32),
    /// A finger of a hand of which only others were opened.
    #[error("finger {0} is not open, because this hand was opened with other fingers only: open it with this finger")]
    NotOpened(i32),
    /// A stage of a cycle that is not known.
    #[error("there is no stage {0}: stages are TIMING_WAKE_UP to TIMING_AGE, 0 to 7")]
    NoSuchStage(i32),
    /// A set point that the finger cannot take.
    #[error(transparent)]
    SetPoint(#[from] SetPointError),
    /// A configuration that cannot be read, used, changed or stored.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// A faulted finger that cannot recover.
    #[error(transparent)]
    Recovery(#[from] RecoveryError),
    /// A finger has stopped by itself.
    #[error("finger {finger} is faulted: {fault} (fault {})", fault.kind.number())]
    Faulted {
        /// 1 to 3.
        finger: i32,
        /// What happened.
        fault: Fault,
    },
    /// A finger has stopped while the hand was being opened.
    #[error(
        "finger {finger} faulted while the hand was being opened, and the hand is closed again: {fault} (fault {}). \
         Call OpenHand where RecoverHand is named",
        fault.kind.number()
    )]
    FaultedAtOpening {
        /// 1 to 3.
        finger: i32,
        /// What happened.
        fault: Fault,
    },
    /// A port or board that does not serve.
    #[error("finger {finger}: {source} (fault {})", Fault::from(source).kind.number())]
    Link {
        /// 1 to 3.
        finger: usize,
        /// What is wrong with it.
        source: LinkError,
    },
    /// Boards at two ports that say that they are the same.
    #[error(
        "the boards of fingers {} ({}) and {} ({}) report the same unique number, {number}, so that they cannot be \
         told apart: give every board a number of its own in its firmware, for example that of its processor with the \
         finger's address in it (fault {code})",
        fingers[0], ShownPath(&ports[0]), fingers[1], ShownPath(&ports[1]), code = FaultKind::SameNumber.number()
    )]
    SameNumber {
        /// 1 to 3.
        fingers: [i32; 2],
        /// Where they are.
        ports: [PathBuf; 2],
        /// Bytes in hex.
        number: String,
    },
    /// The system refuses a thread or a pseudo terminal.
    #[error("cannot {doing}: {}", with_remedy(source))]
    System {
        /// What was being done.
        doing: &'static str,
        /// What the system says.
        source: std::io::Error,
    },
    /// Real time that is enforced and cannot be had.
    #[error("no real time: {missing}, or set `hand.real_time = \"try\"` to do without")]
    NotRealTime {
        /// What cannot be had, why, and what to change.
        missing: MissingPermission,
    },
    /// A calibration gave up.
    #[error(
        "finger {finger} is not calibrated, {}, and nothing was changed: {obstacle}",
        if *limp { "its motors are off" } else { "it holds its pose" }
    )]
    Calibration {
        /// 1 to 3.
        finger: i32,
        /// Whether the finger is limp now. Else it is the spring that it was before.
        limp: bool,
        /// What stood in the way.
        obstacle: Obstacle,
    },
    /// A finger that is doing something else.
    #[error("finger {0} is being opened, calibrated or closed: wait until that is done")]
    Busy(i32),
    /// A servo that takes no order.
    #[error(
        "finger {0} does not respond: the hand was closed or opened again during the call, or its servo thread does \
         not run. GetStatus shows its state; CloseHand and OpenHand start it again"
    )]
    NoAnswer(i32),
    /// A calibration that is in force and not stored.
    #[error("finger {finger} is calibrated until its hand is closed, but this is not stored: {source}")]
    NotStored {
        /// 1 to 3.
        finger: i32,
        /// Why not.
        source: ConfigurationError,
    },
    /// A black box that cannot be written.
    #[error(
        "cannot write the black box to {}: {source}. Name a file in a folder that exists, has room and can be written \
         to by this user",
        ShownPath(path)
    )]
    BlackBox {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A cycle that is not in the black box.
    #[error(
        "cycle {cycle} of finger {finger} is not kept: ask for one from FingerRecord.Oldest to FingerRecord.Newest, \
         which span the last two seconds, or for 0, the newest"
    )]
    NoRecord {
        /// 1 to 3.
        finger: i32,
        /// What was asked for; 0: the newest.
        cycle: u64,
    },
    /// A push beyond what any finger bears.
    #[error(
        "a force of {force:.3e} N on finger {finger} is above {strongest} N, the largest that a simulated finger \
         takes: push with less"
    )]
    TooMuchForce {
        /// 1 to 3.
        finger: i32,
        /// The largest component, N.
        force: f64,
        /// The bound, N.
        strongest: f64,
    },
    /// Pushing a finger that is not simulated.
    #[error("finger {0} is on a real port: PushFinger pushes simulated fingers only (`port = \"simulated\"`)")]
    NotSimulated(i32),
}

impl From<UnusableConfiguration> for HandError {
    fn from(refusal: UnusableConfiguration) -> Self {
        ConfigurationError::from(refusal).into()
    }
}
