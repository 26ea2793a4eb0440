//! Why a call was refused, and what to do about it.

mod errno;

use crate::board::LinkError;
use crate::calibration::Obstacle;
use crate::finger::{Fault, FaultKind};
use crate::hand::missing_permissions::MissingPermission;
use crate::model::OutOfReach;
use crate::model::configuration::Unusable;
use crate::model::{ContactError, Shown, ShownPath, UnusableConfiguration};
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
    /// NaN or infinity in an argument.
    #[error("{what} of finger {finger} contains {value}: every entry must be a finite number")]
    NotFinite {
        /// The argument.
        what: &'static str,
        /// 1 to 3.
        finger: i32,
        /// The first such entry.
        value: f64,
    },
    /// Pos outside the joint limits.
    #[error(
        "Pos[{joint}] = {value:.4} rad is outside the limits of finger {finger}, {low:.4} to {high:.4} rad: send an \
         angle inside them, change `finger.joints`, or set `hand.out_of_range = \"clamp\"`"
    )]
    BeyondJointLimit {
        /// 1 to 3.
        finger: i32,
        /// 0 to 2.
        joint: usize,
        /// What was asked, rad.
        value: f64,
        /// Lower limit, rad.
        low: f64,
        /// Upper limit, rad.
        high: f64,
    },
    /// Kx stiffer than the bound.
    #[error(
        "the largest eigenvalue of Kx of finger {finger} is {largest:.3} N/cm, above the bound of {bound:.3} N/cm: \
         send a softer Kx, or set `hand.out_of_range = \"clamp\"`"
    )]
    TooStiff {
        /// 1 to 3.
        finger: i32,
        /// Largest eigenvalue, N/cm.
        largest: f64,
        /// The bound, N/cm.
        bound: f64,
    },
    /// Kx not symmetric.
    #[error(
        "Kx of finger {finger} is not symmetric: Kx[{row}][{column}] and Kx[{column}][{row}] differ by \
         {difference:.3e} N/cm, more than a thousandth of its largest entry. Send a symmetric Kx, as every spring has"
    )]
    NotSymmetric {
        /// 1 to 3.
        finger: i32,
        /// Row of the worst pair.
        row: usize,
        /// Column of the worst pair.
        column: usize,
        /// Their difference, N/cm.
        difference: f64,
    },
    /// Kx with a negative eigenvalue.
    #[error(
        "Kx of finger {finger} has the negative eigenvalue {smallest:.3e} N/cm, so the finger would push itself away \
         from its set point: send a Kx whose eigenvalues are zero or positive"
    )]
    Negative {
        /// 1 to 3.
        finger: i32,
        /// Smallest eigenvalue, N/cm.
        smallest: f64,
    },
    /// A fingertip position that the finger does not reach.
    #[error("the tip of finger {finger} cannot be at {:.3}, {:.3}, {:.3} cm: {source}", tip[0], tip[1], tip[2])]
    OutOfReach {
        /// 1 to 3.
        finger: i32,
        /// What was asked, cm.
        tip: [f64; 3],
        /// Why not.
        source: OutOfReach,
    },
    /// The stiffness of a contact that is none.
    #[error("the contact of finger {finger}: {source}")]
    Contact {
        /// 1 to 3.
        finger: i32,
        /// What is wrong with it.
        source: ContactError,
    },
    /// A contact of a type that is not known.
    #[error(
        "there is no contact of {0} dimensions: 1 is a frictionless point, 3 a hard finger with friction, 4 a soft \
         finger"
    )]
    NoSuchContact(i32),
    /// A damping ratio outside its range.
    #[error(
        "the damping {ratio} of finger {finger} is outside {least:.2} to {most:.2}, the range in which a spring of \
         {stiffness:.4} N/cm comes to rest: send a ratio inside the range or a softer Kx first, or set \
         `hand.out_of_range = \"clamp\"`"
    )]
    Damping {
        /// 1 to 3.
        finger: i32,
        /// Relative to the damping that the controller chooses.
        ratio: f64,
        /// Largest eigenvalue of the stiffness that goes with it, N/cm.
        stiffness: f64,
        /// Least.
        least: f64,
        /// Most.
        most: f64,
    },
    /// Keys to adjust that cannot be read.
    #[error("finger {finger}, line {line} of the keys to adjust: {reason}")]
    Adjustment {
        /// 1 to 3.
        finger: i32,
        /// Counted from 1.
        line: usize,
        /// What is wrong with it.
        reason: String,
    },
    /// A key that cannot change while the hand is open.
    #[error("`{key}` cannot change while the hand is open: CloseHand, change the configuration file, OpenHand")]
    Permanent {
        /// With dots, relative to the finger.
        key: String,
    },
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
    /// A configuration file cannot be read.
    #[error(
        "cannot read the configuration file {}: {source}. It must be a text file of at most 1 MiB that this \
         user can read; where SUN2XP_CONFIG names one it must exist",
        ShownPath(path)
    )]
    ConfigurationFile {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A configuration file that the environment names, in a program with raised privileges.
    #[error(
        "SUN2XP_CONFIG names {}, but this program is setuid or setgid, or has capabilities, and does not trust its \
         environment: unset SUN2XP_CONFIG, and describe the hand in {system}",
        ShownPath(path)
    )]
    UntrustedEnvironment {
        /// What the environment names.
        path: PathBuf,
        /// The file that is read instead.
        system: &'static str,
    },
    /// A configuration that cannot be used.
    #[error("{}{}: {reason}", ShownPath(file), line.map(|line| format!(":{line}")).unwrap_or_default())]
    Configuration {
        /// The file.
        file: PathBuf,
        /// The line, counted from 1, where the key stands in the file.
        line: Option<usize>,
        /// What is wrong with it.
        reason: String,
    },
    /// A configuration made in a program that cannot be used.
    #[error("{section}.{}: {}", unusable.key, unusable.reason)]
    Unusable {
        /// `hand`, or `finger.1` to `finger.3`.
        section: String,
        /// The key and the reason.
        unusable: Unusable,
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
    /// What was found cannot be written.
    #[error(
        "cannot write into the configuration file {}: {source}. This user must be able to write the file and its \
         folder",
        ShownPath(path)
    )]
    Store {
        /// The configuration file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// What was found holds for something else than the configuration file now says.
    #[error(
        "what was found does not belong to {}: {key} is {} there, and was {} when it was found. Nothing was written: \
         make the two agree and find it again",
        ShownPath(path),
        Shown(is),
        Shown(was)
    )]
    Unfit {
        /// The configuration file.
        path: PathBuf,
        /// The key that differs.
        key: String,
        /// Its value when it was found.
        was: String,
        /// Its value in the file.
        is: String,
    },
    /// A calibration that is in force and not stored.
    #[error("finger {finger} is calibrated until its hand is closed, but this is not stored: {source}")]
    NotStored {
        /// 1 to 3.
        finger: i32,
        /// Why not.
        source: Box<HandError>,
    },
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
        let section = refusal.finger.map_or("hand".into(), |index| format!("finger.{}", index + 1));
        Self::Unusable { section, unusable: refusal.unusable }
    }
}
