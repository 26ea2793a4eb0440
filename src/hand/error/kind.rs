//! The kind of an error, without the values in it.

use super::{ConfigurationError, HandError, PathError, RecoveryError, ReflexError, SetPointError};
use std::mem::{Discriminant, discriminant};

/// The kind of a [`HandError`]. Two errors that differ only in their values have the same kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ErrorKind {
    error: Discriminant<HandError>,
    cause: Cause,
}

/// For the variants of [`HandError`] that only wrap an error of one of the types below, this is the variant of the
/// inner error. For all other variants, it is `None`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cause {
    None,
    SetPoint(Discriminant<SetPointError>),
    Path(Discriminant<PathError>),
    Configuration(Discriminant<ConfigurationError>),
    Recovery(Discriminant<RecoveryError>),
    Reflex(Discriminant<ReflexError>),
}

impl HandError {
    /// The kind of this error.
    pub(crate) fn kind(&self) -> ErrorKind {
        let cause = match self {
            Self::SetPoint(error) => Cause::SetPoint(discriminant(error)),
            Self::Path(error) => Cause::Path(discriminant(error)),
            Self::Configuration(error) => Cause::Configuration(discriminant(error)),
            Self::Recovery(error) => Cause::Recovery(discriminant(error)),
            Self::Reflex(error) => Cause::Reflex(discriminant(error)),
            _ => Cause::None,
        };
        ErrorKind { error: discriminant(self), cause }
    }
}
