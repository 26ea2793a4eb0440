//! The error for a configuration key whose value is refused.

use thiserror::Error;

/// A key whose value cannot be used, and the reason. The key is relative to its section, with dots: `tendon.maximum` in
/// `[finger]`.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{key}: {reason}")]
pub struct Unusable {
    /// Dotted path of the key.
    pub key: &'static str,
    /// The reason, with the numbers and with usable values.
    pub reason: String,
}
