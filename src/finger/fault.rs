//! Why a finger stopped by itself.

use crate::board::protocol::Refused;
use thiserror::Error;

/// What made a finger fault. Its motors are then in the configured end state.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum Fault {
    /// No valid reply for as long as the board's watchdog waits.
    #[error(
        "no valid reply from the board for {milliseconds} ms: cable out, board without power, or too much noise on the line"
    )]
    LinkLost {
        /// How long, ms.
        milliseconds: u32,
    },
    /// The port reports an error or is gone.
    #[error("the serial port failed (errno {errno}): adapter unplugged? Plug it in, CloseHand, OpenHand")]
    PortFailed {
        /// What the system said.
        errno: i32,
    },
    /// The board stopped the motors because it heard no command in time.
    #[error(
        "the board's watchdog stopped the motors: commands came too late. Is the servo real-time, is the machine overloaded?"
    )]
    WatchdogTripped,
    /// The board reports a fault of its own, or its emergency stop.
    #[error("the board stopped the motors and reports status {status:#06x} (docs/board-protocol.md, status bits)")]
    BoardStopped {
        /// Status bits of the reply.
        status: u16,
    },
    /// The board refuses the commands of this finger.
    #[error("the board refuses commands: {refused}. Mend that, CloseHand, OpenHand")]
    CommandRefused {
        /// What it said.
        refused: Refused,
    },
    /// A tendon did not come under tension at open.
    #[error(
        "tendon {tendon} did not come under tension within {milliseconds} ms of taking up slack: is it broken, off its \
         pulley, is a motor or gauge sign wrong, is its gauge dead?"
    )]
    SlackTendon {
        /// 1 to 4.
        tendon: u8,
        /// How long it was tried, ms.
        milliseconds: u32,
    },
    /// The encoders tell joint angles that the finger cannot have.
    #[error(
        "joint {joint} reads {degrees} degrees, which it cannot reach: a tendon is broken or off its pulley, an encoder jumped or lost \
         its zero, or an encoder sign is wrong"
    )]
    ImpossiblePose {
        /// 0 to 2.
        joint: u8,
        /// What the encoders say, degrees.
        degrees: i32,
    },
    /// The servo thread panicked: a defect of this library.
    #[error("the servo thread failed: a defect of this library, please report it")]
    Internal,
}
