//! The reasons why a reflex is not installed or not removed.

use crate::finger::MOST_RULES;
use crate::model::FingerNumber;
use thiserror::Error;

/// The reason why a reflex is not installed or not removed.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReflexError {
    /// A value of the rule is outside its range.
    #[error(
        "the reflex for finger {finger} is refused: its {what}, {value:?}{unit}, is not between {low} and {high}: \
         choose a value in this range"
    )]
    Value {
        /// The finger.
        finger: FingerNumber,
        /// What the value is.
        what: &'static str,
        /// The value.
        value: f64,
        /// The smallest permitted value.
        low: f64,
        /// The largest permitted value.
        high: f64,
        /// The unit after a space, or nothing.
        unit: &'static str,
    },
    /// The finger has no such joint.
    #[error("the reflex for finger {finger} is refused: there is no joint {joint}: joints are 0, 1 and 2")]
    NoSuchJoint {
        /// The finger.
        finger: FingerNumber,
        /// The joint that the planner has passed.
        joint: i64,
    },
    /// The other finger of the rule is the finger itself.
    #[error(
        "the reflex for finger {0} is refused: its condition is an event of another finger, but names finger {0} \
         itself: name another finger, or use the condition for an event of the same finger"
    )]
    OwnFinger(FingerNumber),
    /// The finger already has as many rules as it can have.
    #[error("finger {0} already has {MOST_RULES} reflexes: remove one first")]
    TooMany(FingerNumber),
    /// There is no rule with this number.
    #[error(
        "finger {finger} has no reflex {rule}, because it was removed or never installed: use the number that was \
         returned when the reflex was installed, or install it again"
    )]
    NoSuchRule {
        /// The finger.
        finger: FingerNumber,
        /// The number of the rule.
        rule: u32,
    },
    /// A C program has passed a number that no condition, reaction or event has.
    #[error("there is no {what} {number}: use one of the constants of sun2xp.h that begin with {prefix}")]
    NoSuchKind {
        /// Condition, reaction or event.
        what: &'static str,
        /// The number.
        number: i32,
        /// The first letters of the constants.
        prefix: &'static str,
    },
}

impl ReflexError {
    /// Returns the errno that describes the error best.
    #[must_use]
    pub fn errno(&self) -> i32 {
        match self {
            Self::Value { .. } => libc::ERANGE,
            Self::NoSuchJoint { .. } | Self::OwnFinger(_) | Self::NoSuchKind { .. } => libc::EINVAL,
            Self::TooMany(_) => libc::ENOSPC,
            Self::NoSuchRule { .. } => libc::ENOENT,
        }
    }
}
