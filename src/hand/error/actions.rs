//! The operations that the remedy of an error names.

use super::{ConfigurationError, HandError, RecoveryError};
use crate::board::{LinkError, PortError};
use crate::finger::Action;

impl HandError {
    /// The operations of the library that the remedy names, in the order of their use. The C interface adds the names
    /// of its calls to the text.
    pub(crate) fn actions(&self) -> &'static [Action] {
        match self {
            Self::Faulted { fault, .. } => fault.kind.description().actions,
            Self::FaultedAtOpening { .. } => &[Action::Open],
            Self::Limp(_) => &[Action::Zero, Action::Close, Action::Open],
            Self::NoAnswer(_) => &[Action::QueryStatus, Action::Close, Action::Open],
            Self::Link { source: LinkError::Port(PortError::Closed), .. } => &[Action::Close, Action::Open],
            Self::Configuration(ConfigurationError::Permanent { .. }) => &[Action::Close, Action::Open],
            Self::Recovery(error) => match error {
                RecoveryError::ServoStalled(_) => &[Action::Recover],
                RecoveryError::ServoEnded(_) => &[Action::Close, Action::Open],
                RecoveryError::NotReconnected(_) => &[Action::Close, Action::Open],
            },
            _ => &[],
        }
    }
}
