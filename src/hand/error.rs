//! The errors of the hand: each text names the cause and the remedy.

mod actions;
mod configuration;
mod errno;
mod kind;
mod path;
mod recovery;
mod reflex;
mod set_point;

pub use configuration::ConfigurationError;
pub(crate) use kind::ErrorKind;
pub use path::PathError;
pub use recovery::RecoveryError;
pub use reflex::ReflexError;
pub use set_point::SetPointError;

use crate::board::LinkError;
use crate::calibration::Obstacle;
use crate::finger::{Fault, FaultKind};
use crate::hand::missing_permissions::MissingPermission;
use crate::model::configuration::BoardNumber;
use crate::model::{Counted, FingerNumber, Fingers};
use crate::model::{ShownPath, UnusableConfiguration};
use crate::realtime::{with_remedy, with_terminal_remedy};
use std::path::PathBuf;
use thiserror::Error;

/// A call that was refused or that failed. A refused call changes nothing. The text names the cause and the remedy.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum HandError {
    /// The number of a finger is not 1, 2 or 3.
    #[error("there is no finger {0}: fingers are 1, 2 and 3")]
    NoSuchFinger(i32),
    /// The hand was opened without this finger.
    #[error("the hand was opened without finger {0}: open it with this finger")]
    NotOpened(FingerNumber),
    /// The hand does not have this finger.
    #[error(
        "this hand has no finger {finger}, because its configuration has hand.fingers = {fingers}: add {finger} to \
         hand.fingers if the finger exists"
    )]
    NotInHand {
        /// The finger.
        finger: FingerNumber,
        /// The fingers that the hand has.
        fingers: Fingers,
    },
    /// The servo cycle has no stage with this number.
    #[error("there is no stage {0}: the stages of a cycle are 0 to 7")]
    NoSuchStage(i32),
    /// The finger has no tactile element with this number.
    #[error(
        "finger {finger} has no tactile element with the number {element}, because its configuration lists {listed} \
         and the numbers begin at 0: use the number of a listed element, or list it in [finger.{finger}.touch]",
        listed = Counted(*count as u64, "element", "elements")
    )]
    NoSuchElement {
        /// The finger.
        finger: FingerNumber,
        /// The requested element.
        element: usize,
        /// The number of elements.
        count: usize,
    },
    /// A set point that the finger cannot take.
    #[error(transparent)]
    SetPoint(#[from] SetPointError),
    /// A path that the finger cannot follow.
    #[error(transparent)]
    Path(#[from] PathError),
    /// A configuration that cannot be read, used, changed or stored.
    #[error(transparent)]
    Configuration(#[from] ConfigurationError),
    /// A faulted finger that cannot recover.
    #[error(transparent)]
    Recovery(#[from] RecoveryError),
    /// A reflex that cannot be installed or removed.
    #[error(transparent)]
    Reflex(#[from] ReflexError),
    /// The finger has stopped because of a fault.
    #[error("finger {finger} is faulted (fault {}): {fault}", fault.kind.number())]
    Faulted {
        /// The finger.
        finger: FingerNumber,
        /// The fault.
        fault: Fault,
    },
    /// A finger faulted while the hand was being opened.
    #[error(
        "the hand is not open, because finger {finger} faulted during opening (fault {}): {fault}. Open the hand again \
         instead of recovering the finger",
        fault.kind.number()
    )]
    FaultedAtOpening {
        /// The finger.
        finger: FingerNumber,
        /// The fault.
        fault: Fault,
    },
    /// The port or the board does not work.
    #[error("finger {finger} (fault {}): {source}", Fault::from(source).kind.number())]
    Link {
        /// The finger.
        finger: FingerNumber,
        /// What is wrong with the port or the board.
        source: LinkError,
    },
    /// The board that the configuration names by its unique number was not found, or was found at several ports.
    #[error(
        "finger {finger}: the board with the number {number} of finger.{finger}.board was {searched} {patterns}. \
         Found: {found}. Connect exactly one board with this number and switch it on, correct finger.{finger}.board, \
         or add its port to hand.search_ports"
    )]
    NoSuchBoard {
        /// The finger.
        finger: FingerNumber,
        /// The unique number of its board.
        number: BoardNumber,
        /// The patterns of the ports that were searched.
        patterns: String,
        /// What answered at each port.
        found: String,
        /// "not found at", or "found at several of the ports" if boards at two or more ports report the number.
        searched: &'static str,
    },
    /// The self-test of a finger has found a part that is wired wrongly. The motors of the finger are off.
    #[error("finger {finger} (fault {}): {obstacle}", FaultKind::WrongWiring.number())]
    WrongWiring {
        /// The finger.
        finger: FingerNumber,
        /// What is wrong, and its remedy.
        obstacle: Obstacle,
    },
    /// The boards at two ports report the same unique number.
    #[error(
        "the boards of fingers {} ({}) and {} ({}) report the same unique number, {number}, and cannot be \
         distinguished (fault {code}): give every board its own number in its firmware, for example the number of its \
         processor combined with the finger's address",
        fingers[0], ShownPath(&ports[0]), fingers[1], ShownPath(&ports[1]), code = FaultKind::SameNumber.number()
    )]
    SameNumber {
        /// The two fingers.
        fingers: [FingerNumber; 2],
        /// Their ports.
        ports: [PathBuf; 2],
        /// The bytes of the number in hexadecimal.
        number: String,
    },
    /// The system cannot start the thread or open the pseudo-terminal of a simulated board.
    #[error("cannot start the simulated board on a pseudo-terminal: {}", with_terminal_remedy(.0))]
    SimulatedPort(std::io::Error),
    /// The system refuses an operation, such as starting a thread or creating a descriptor, or the program ended while
    /// the hand was being opened.
    #[error("cannot {doing}: {}", with_remedy(source))]
    System {
        /// The refused operation.
        doing: &'static str,
        /// The error that the system reported.
        source: std::io::Error,
    },
    /// `hand.real_time` is `enforce`, but the system does not permit real-time operation.
    #[error("real-time operation is not permitted: {missing}, or set `hand.real_time = \"try\"` to run without it")]
    NotRealTime {
        /// What is not permitted, the reason and the remedy.
        missing: MissingPermission,
    },
    /// A calibration failed.
    #[error(
        "the calibration of finger {finger} failed ({}, and its previous calibration is in force): {obstacle}",
        if *limp { "its motors are off" } else { "the finger still holds its pose" }
    )]
    Calibration {
        /// The finger.
        finger: FingerNumber,
        /// Whether the finger is limp now. If false, the finger is still the spring that it was before the calibration.
        limp: bool,
        /// The cause and the remedy.
        obstacle: Obstacle,
    },
    /// A calibration was interrupted. Its results stay in force if they were in force already.
    #[error(
        "the calibration of finger {0} was interrupted, because the finger faulted and recovered, or because the hand \
         is being closed. If its results were already in force, they stay in force. Otherwise the previous calibration \
         is in force. Calibrate the finger again"
    )]
    Interrupted(FingerNumber),
    /// The finger is busy.
    #[error("finger {0} is being opened, recovered, calibrated or closed: wait until this is done")]
    Busy(FingerNumber),
    /// The motors of the finger are off, and no call is in progress that switches them on.
    #[error(
        "the motors of finger {0} are off. Either its last calibration failed, or a call found the signs of its \
         motors, encoders and gauges, or a call tested its wiring, or a program opened the hand with the motors off: \
         zero or identify the finger, or close the hand and open it again"
    )]
    Limp(FingerNumber),
    /// A wait has reached its time limit.
    #[error(
        "finger {0} has not arrived or settled within the time limit: check what keeps it from moving, send a set \
         point that it can reach, or wait longer"
    )]
    NotThereInTime(FingerNumber),
    /// The servo does not respond.
    #[error(
        "finger {0} does not respond: the hand was closed or opened again during the call, or the finger's servo \
         thread does not run. Check the finger's status; to start the thread again, close the hand and open it again"
    )]
    NoAnswer(FingerNumber),
    /// A calibration is in force, but it could not be stored.
    #[error(
        "the calibration of finger {finger} is in force until the hand is closed, but it is not stored: {source}{}",
        storing_remedy(source)
    )]
    NotStored {
        /// The finger.
        finger: FingerNumber,
        /// The reason.
        source: ConfigurationError,
    },
    /// The black box cannot be written.
    #[error(
        "cannot write the black box to {}: {source}. Name a file in a folder that exists, has free space and is \
         writable for this user",
        ShownPath(path)
    )]
    BlackBox {
        /// The file.
        path: PathBuf,
        /// The error that the system reported.
        source: std::io::Error,
    },
    /// The cycle is not in the black box.
    #[error(
        "cycle {cycle} of finger {finger} is not in the black box, which contains the cycles of the last two seconds: \
         request one of these cycles, or the newest one"
    )]
    NoRecord {
        /// The finger.
        finger: FingerNumber,
        /// The requested cycle. 0 means the newest cycle.
        cycle: u64,
    },
    /// A component of the force is too large for a simulated finger.
    #[error(
        "a component of the force on finger {finger} has a magnitude of {force:.3e} N, above {strongest} N, the \
         largest permitted magnitude on a simulated finger: use a force whose components are smaller"
    )]
    TooMuchForce {
        /// The finger.
        finger: FingerNumber,
        /// The magnitude of the largest component of the requested force, N.
        force: f64,
        /// The largest permitted magnitude of a component, N.
        strongest: f64,
    },
    /// Only a simulated finger can be pushed.
    #[error("finger {0} is not simulated: only a simulated finger (`port = \"simulated\"`) can be pushed")]
    NotSimulated(FingerNumber),
    /// The hand has no simulated object.
    #[error(
        "the hand has no simulated object: configure [hand.simulated_object] and a finger with `port = \"simulated\"`"
    )]
    NoObject,
}

/// The remedy for a calibration that is not stored, as a sentence after the reason. The text of `Mismatch` already
/// contains its remedy.
fn storing_remedy(reason: &ConfigurationError) -> &'static str {
    match reason {
        ConfigurationError::Mismatch { .. } => "",
        _ => ". Remove the cause and calibrate the finger again",
    }
}

impl From<UnusableConfiguration> for HandError {
    fn from(refusal: UnusableConfiguration) -> Self {
        ConfigurationError::from(refusal).into()
    }
}
