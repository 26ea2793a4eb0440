//! The kind of an error, without its figures.

use super::{ConfigurationError, HandError, RecoveryError, SetPointError};
use std::mem::{Discriminant, discriminant};

/// The kind of a [`HandError`]: the same for two errors that differ only in their figures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ErrorKind {
    error: Discriminant<HandError>,
    cause: Cause,
}

/// The variant of the error inside a [`HandError`], for those that are grouped by concept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cause {
    None,
    SetPoint(Discriminant<SetPointError>),
    Configuration(Discriminant<ConfigurationError>),
    Recovery(Discriminant<RecoveryError>),
}

impl HandError {
    /// The kind of this error.
    pub(crate) fn kind(&self) -> ErrorKind {
        let cause = match self {
            Self::SetPoint(error) => Cause::SetPoint(discriminant(error)),
            Self::Configuration(error) => Cause::Configuration(discriminant(error)),
            Self::Recovery(error) => Cause::Recovery(discriminant(error)),
            _ => Cause::None,
        };
        ErrorKind { error: discriminant(self), cause }
    }
}
