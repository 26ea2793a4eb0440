//! The exceptions of refused calls.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use sun2xp::finger::FaultKind;
use sun2xp::{ConfigurationError, HandError};

/// Why a call is refused.
#[derive(Debug)]
pub enum Refusal {
    /// The hand is closed.
    Closed,
    /// This process was forked from the process that has opened the hand.
    Forked,
    /// An argument has a wrong shape or value.
    Argument(String),
    /// A recording cannot be read.
    Recording(String),
    /// The library has failed.
    Defect,
    /// The hand refuses the call.
    Hand(HandError),
}

impl From<HandError> for Refusal {
    fn from(error: HandError) -> Self {
        Self::Hand(error)
    }
}

impl Refusal {
    /// Returns the exception.
    pub fn raise(&self, py: Python<'_>) -> PyErr {
        self.exception(py).unwrap_or_else(|error| error)
    }

    fn exception(&self, py: Python<'_>) -> PyResult<PyErr> {
        let details = PyDict::new(py);
        details.set_item("number", self.number())?;
        details.set_item("errno", self.errno())?;
        details.set_item("remedy", self.remedy())?;
        if let Some((finger, fault)) = self.fault() {
            details.set_item("finger", finger)?;
            details.set_item("fault", fault.number())?;
        }
        let class = py.import("sun2xp._errors")?.getattr(self.class())?;
        Ok(PyErr::from_value(class.call((self.text(),), Some(&details))?))
    }

    /// The name of the exception's class in sun2xp/_errors.py. Programs distinguish errors by their classes.
    fn class(&self) -> &'static str {
        match self {
            Self::Closed => "Closed",
            Self::Argument(_) => "Refused",
            Self::Forked | Self::Recording(_) | Self::Defect => "Error",
            Self::Hand(error) => match error {
                HandError::Faulted { .. } | HandError::FaultedAtOpening { .. } | HandError::WrongWiring { .. } => {
                    "Fault"
                }
                HandError::Configuration(ConfigurationError::Permanent { .. }) => "Refused",
                HandError::Configuration(_) | HandError::NotStored { .. } => "ConfigurationError",
                HandError::NotThereInTime(_) => "TimedOut",
                HandError::NoSuchFinger(_)
                | HandError::NotOpened(_)
                | HandError::NotInHand { .. }
                | HandError::NoSuchElement { .. }
                | HandError::SetPoint(_)
                | HandError::Path(_)
                | HandError::Reflex(_)
                | HandError::NoRecord { .. }
                | HandError::TooMuchForce { .. }
                | HandError::NotSimulated(_)
                | HandError::NoObject
                | HandError::Busy(_)
                | HandError::Limp(_) => "Refused",
                _ => "Error",
            },
        }
    }

    /// The number of the C interface: SUN2XP_ERROR_..., and `ErrorNumber` in sun2xp/_errors.py.
    fn number(&self) -> i32 {
        match self {
            Self::Defect => 1,
            Self::Forked => 2,
            Self::Closed => 4,
            Self::Argument(_) => 7,
            Self::Recording(_) => 12,
            Self::Hand(error) => sun2xp::capi::error_number(error),
        }
    }

    /// The errno of the C interface.
    fn errno(&self) -> i32 {
        match self {
            Self::Defect => 5,                            // EIO
            Self::Forked => 1,                            // EPERM
            Self::Closed => 19,                           // ENODEV
            Self::Argument(_) | Self::Recording(_) => 22, // EINVAL
            Self::Hand(error) => error.errno(),
        }
    }

    fn text(&self) -> String {
        match self {
            Self::Closed => "the hand is closed: open it again".into(),
            Self::Forked => "this process was forked from the process that has opened the hand, and only that process \
                             has the servo threads: make the call in that process, or start processes with the \
                             method \"spawn\""
                .into(),
            Self::Argument(text) | Self::Recording(text) => text.clone(),
            Self::Defect => {
                "the library failed: please report this defect, with the message of the panic on standard error".into()
            }
            Self::Hand(error) => error.to_string(),
        }
    }

    /// The finger and the kind of its fault.
    fn fault(&self) -> Option<(i32, FaultKind)> {
        match self {
            Self::Hand(HandError::Faulted { finger, fault } | HandError::FaultedAtOpening { finger, fault }) => {
                Some((finger.get(), fault.kind))
            }
            Self::Hand(HandError::WrongWiring { finger, .. }) => Some((finger.get(), FaultKind::WrongWiring)),
            _ => None,
        }
    }

    /// Returns what the caller should do. For a fault other than wrong wiring, this is the remedy of the fault.
    /// Otherwise it is the part of the text after the last colon, because a text of the library ends with the remedy.
    /// In some texts, a part of the cause stands between the last colon and the remedy.
    fn remedy(&self) -> String {
        // For wrong wiring, the text is used: it ends with the remedy for the wrong connection that was found.
        if let Some((_, fault)) = self.fault()
            && fault != FaultKind::WrongWiring
        {
            return remedy(fault).into();
        }
        let text = self.text();
        text.rsplit_once(": ").map_or(String::new(), |(_, remedy)| remedy.into())
    }
}

/// The remedy for a fault.
pub fn remedy(kind: FaultKind) -> &'static str {
    kind.description().remedy
}
