//! Why a payload is not a message of the protocol.

use crate::MessageKind;
use thiserror::Error;

/// Why a payload cannot be decoded.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum DecodeError {
    /// The payload is too short for a type and a version.
    #[error("{0} bytes are too few for a message: every message begins with its type and its version")]
    Short(usize),
    /// The payload is a message of another type.
    #[error("the type is {found}, and not {} ({expected})", *expected as u8)]
    Kind {
        /// The message that the receiver expects.
        expected: MessageKind,
        /// The type in the payload.
        found: u8,
    },
    /// The payload has another version of the protocol.
    #[error("the version of the protocol is {found}, and not {}", crate::VERSION)]
    Version {
        /// The version in the payload.
        found: u8,
    },
    /// The length does not agree with the fields.
    #[error("{found} bytes, but the fields of {kind} require {expected} bytes")]
    Length {
        /// The message.
        kind: MessageKind,
        /// The length that the fields require. If the payload is too short for the fixed fields of the message or of a
        /// part, a lower bound of this length.
        expected: usize,
        /// The length of the payload.
        found: usize,
    },
    /// A field has a value that docs/remote-protocol.md does not allow.
    #[error("{kind}: {error}")]
    Field {
        /// The message.
        kind: MessageKind,
        /// The field and the reason.
        error: FieldError,
    },
}

/// A field with a value that docs/remote-protocol.md does not allow.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{}{field} {reason}", Numbered(*number))]
pub struct FieldError {
    /// The name of the field.
    pub field: &'static str,
    /// For a field of a part or of a record: "part" or "record", and the index of that part or record in the message,
    /// from 0.
    pub number: Option<(&'static str, usize)>,
    /// What is wrong.
    pub reason: Reason,
}

/// What is wrong with a field.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Reason {
    /// A number is NaN or infinite.
    #[error("must be finite, and not {0}")]
    NotFinite(f64),
    /// A number is zero or negative.
    #[error("is {0}: it must be positive")]
    NotPositive(f64),
    /// A number is negative.
    #[error("is {0}: it must not be negative")]
    Negative(f64),
    /// A fraction is outside 0 to 1.
    #[error("is {0}: it must be 0 to 1")]
    NotAFraction(f64),
    /// A whole number is outside its range.
    #[error("is {value}: it must be {least} to {most}")]
    Outside {
        /// The value.
        value: u64,
        /// The smallest allowed value.
        least: u64,
        /// The largest allowed value.
        most: u64,
    },
    /// A value is not higher than the previous one.
    #[error("must be higher than that of {0}")]
    NotRising(&'static str),
    /// The time of a pose of a path is not above 0, or not higher than the time of the pose before.
    #[error("must be above 0 and higher than that of the pose before, but pose {pose} has the time {time} s")]
    PoseTime {
        /// The index of the pose in the path, from 0.
        pose: usize,
        /// Its time, s.
        time: f64,
    },
    /// The largest angle of a joint is below its smallest angle.
    #[error(
        "must not be below the smallest, but joint {joint} has the largest angle {largest} rad and the smallest angle \
         {smallest} rad"
    )]
    BelowSmallest {
        /// The joint, 0 to 2.
        joint: usize,
        /// Its largest angle, rad.
        largest: f64,
        /// Its smallest angle, rad.
        smallest: f64,
    },
    /// The message does not give a value, but the bytes of this value are not zero.
    #[error("must have only zero bytes, because no value is given")]
    NotZero,
    /// The bytes after a text, up to the end of its field, are not zero.
    #[error("must be zero")]
    NotPadding,
    /// Bits are set that have no meaning, or that this message must not have.
    #[error("has the value {0:#x}, with bits that have no meaning or that this message must not have")]
    Bits(u8),
    /// A text is not UTF-8.
    #[error("is not UTF-8")]
    NotText,
    /// A text is longer than the message permits.
    #[error("is longer than {0} bytes")]
    TooLong(usize),
    /// A name has a character that names do not have, or a wrong length.
    #[error("is not a name of a client")]
    NotAName,
    /// One field contradicts another.
    #[error("contradicts {0}")]
    Contradicts(&'static str),
}

impl FieldError {
    pub(crate) fn new(field: &'static str, reason: Reason) -> Self {
        Self { field, number: None, reason }
    }

    /// The same error, in the part or record with this number.
    pub(crate) fn within(self, what: &'static str, number: usize) -> Self {
        Self { number: Some((what, number)), ..self }
    }

    pub(crate) fn of(self, kind: MessageKind) -> DecodeError {
        DecodeError::Field { kind, error: self }
    }
}

struct Numbered(Option<(&'static str, usize)>);

impl std::fmt::Display for Numbered {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.0 {
            Some((what, number)) => write!(formatter, "{what} {number}, "),
            None => Ok(()),
        }
    }
}

/// Refuses NaN and infinity.
pub(crate) fn finite(field: &'static str, values: &[f64]) -> Result<(), FieldError> {
    match values.iter().find(|value| !value.is_finite()) {
        None => Ok(()),
        Some(&value) => Err(FieldError::new(field, Reason::NotFinite(value))),
    }
}

/// Refuses whole numbers outside a range.
pub(crate) fn within(field: &'static str, value: u64, least: u64, most: u64) -> Result<(), FieldError> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(FieldError::new(field, Reason::Outside { value, least, most }))
}
