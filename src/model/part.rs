//! Parts of a finger, as the texts of faults and refusals name them.

use serde::{Deserialize, Serialize};
use std::fmt;

/// A part of a finger. The numbers are those that planners see.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub enum Part {
    /// The whole finger, or an unknown part.
    Finger,
    /// A joint, 0 to 2.
    Joint(u8),
    /// A tendon, 1 to 4.
    Tendon(u8),
    /// A motor, 1 to 4.
    Motor(u8),
    /// A strain gauge, 1 to 4.
    Gauge(u8),
    /// A motor encoder, 1 to 4.
    Encoder(u8),
}

impl Part {
    /// Returns the joint with this index, 0 to 2.
    #[must_use]
    pub fn joint(index: usize) -> Self {
        Self::Joint(index as u8)
    }

    /// Returns the tendon with this index, 0 to 3.
    #[must_use]
    pub fn tendon(index: usize) -> Self {
        Self::Tendon(index as u8 + 1)
    }

    /// Returns the motor with this index, 0 to 3.
    #[must_use]
    pub fn motor(index: usize) -> Self {
        Self::Motor(index as u8 + 1)
    }

    /// Returns the strain gauge with this index, 0 to 3.
    #[must_use]
    pub fn gauge(index: usize) -> Self {
        Self::Gauge(index as u8 + 1)
    }

    /// Returns the motor encoder with this index, 0 to 3.
    #[must_use]
    pub fn encoder(index: usize) -> Self {
        Self::Encoder(index as u8 + 1)
    }

    /// Returns the number in the C interface: 0 to 2 for joints, 1 to 4 for the other parts, 0 for the whole finger.
    #[must_use]
    pub fn number(self) -> u8 {
        match self {
            Part::Finger => 0,
            Part::Joint(number)
            | Part::Tendon(number)
            | Part::Motor(number)
            | Part::Gauge(number)
            | Part::Encoder(number) => number,
        }
    }
}

/// Writes a part as it appears in a sentence: `joint 0`, `tendon 3`.
impl fmt::Display for Part {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Part::Finger => formatter.write_str("finger"),
            Part::Joint(number) => write!(formatter, "joint {number}"),
            Part::Tendon(number) => write!(formatter, "tendon {number}"),
            Part::Motor(number) => write!(formatter, "motor {number}"),
            Part::Gauge(number) => write!(formatter, "gauge {number}"),
            Part::Encoder(number) => write!(formatter, "encoder {number}"),
        }
    }
}
