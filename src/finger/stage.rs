//! The stages of a finger between open and close.

use crate::finger::Fault;
use std::fmt;

/// Where a finger is between open and close.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Stage {
    /// Tendons are brought under tension.
    #[default]
    Opening,
    /// The motors are off: opened that way, or after a calibration.
    Limp,
    /// A calibration moves the finger.
    Calibrating,
    /// The fingertip is a spring.
    Running,
    /// On the way to the configured end state.
    Closing,
    /// The board is in its end state.
    Closed,
    /// Stopped by itself.
    Faulted(Fault),
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Stage::Opening => "opening",
            Stage::Limp => "limp",
            Stage::Calibrating => "calibrating",
            Stage::Running => "running",
            Stage::Closing => "closing",
            Stage::Closed => "closed",
            Stage::Faulted(fault) => return write!(f, "faulted: {fault}"),
        })
    }
}
