//! The stages of a finger between open and close.

use crate::finger::Fault;
use serde::{Deserialize, Serialize};
use std::fmt;

/// A stage of a finger between open and close.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
#[non_exhaustive]
pub enum Stage {
    /// The finger takes up the slack of its tendons.
    #[default]
    Opening,
    /// The motors are off: the finger was opened or restarted that way, or a calibration has ended.
    Limp,
    /// A calibration is in control of the finger.
    Calibrating,
    /// The finger follows set points: its fingertip behaves as a spring.
    Running,
    /// The finger is being brought to the configured end state.
    Closing,
    /// The finger is in its end state.
    Closed,
    /// The finger has stopped because of a fault.
    Faulted(Fault),
}

impl Stage {
    /// Returns the name of the stage, in one word.
    #[must_use]
    pub fn name(&self) -> &'static str {
        match self {
            Stage::Opening => "opening",
            Stage::Limp => "limp",
            Stage::Calibrating => "calibrating",
            Stage::Running => "running",
            Stage::Closing => "closing",
            Stage::Closed => "closed",
            Stage::Faulted(_) => "faulted",
        }
    }
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())?;
        match self {
            Stage::Faulted(fault) => write!(f, ": {fault}"),
            _ => Ok(()),
        }
    }
}
