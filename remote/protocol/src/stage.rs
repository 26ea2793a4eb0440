//! The stages of a finger.

use crate::error::{FieldError, Reason, within};

/// The stage of a finger between open and close.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The finger takes up the slack of its tendons.
    Opening,
    /// The motors are off.
    Limp,
    /// A calibration is in control of the finger.
    Calibrating,
    /// The fingertip is a spring.
    Running,
    /// The finger is being brought to its end state.
    Closing,
    /// The finger is in its end state.
    Closed,
    /// The finger has stopped because of a fault. The number is that of docs/faults.md, and is not 0.
    Faulted(u16),
}

impl Stage {
    /// The numbers of stage and fault.
    #[must_use]
    pub fn numbers(self) -> (u8, u16) {
        match self {
            Self::Opening => (0, 0),
            Self::Limp => (1, 0),
            Self::Calibrating => (2, 0),
            Self::Running => (3, 0),
            Self::Closing => (4, 0),
            Self::Closed => (5, 0),
            Self::Faulted(fault) => (6, fault),
        }
    }

    /// The name of the stage.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Opening => "opening",
            Self::Limp => "limp",
            Self::Calibrating => "calibrating",
            Self::Running => "running",
            Self::Closing => "closing",
            Self::Closed => "closed",
            Self::Faulted(_) => "faulted",
        }
    }

    pub(crate) fn decode(stage: u8, fault: u16) -> Result<Self, FieldError> {
        within("stage", u64::from(stage), 0, 6)?;
        let decoded = match stage {
            0 => Self::Opening,
            1 => Self::Limp,
            2 => Self::Calibrating,
            3 => Self::Running,
            4 => Self::Closing,
            5 => Self::Closed,
            _ => Self::Faulted(fault),
        };
        match decoded.numbers() == (stage, fault) {
            true => decoded.check().map(|()| decoded),
            false => {
                Err(FieldError::new("number of the fault", Reason::Contradicts("the stage, which is not faulted")))
            }
        }
    }

    pub(crate) fn check(self) -> Result<(), FieldError> {
        match self {
            Self::Faulted(0) => {
                Err(FieldError::new("number of the fault", Reason::Contradicts("the stage, which is faulted")))
            }
            _ => Ok(()),
        }
    }
}
