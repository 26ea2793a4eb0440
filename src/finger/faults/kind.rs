//! Numbers of the kinds of faults.

use super::table::FaultKind;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

impl FaultKind {
    /// Returns the number of the kind, counted from 1. It is the same in every version of this library.
    #[must_use]
    pub fn number(self) -> u8 {
        self as u8
    }

    /// Returns the kind with this number.
    #[must_use]
    pub fn from_number(number: i32) -> Option<Self> {
        Self::ALL.iter().copied().find(|kind| i32::from(kind.number()) == number)
    }
}

impl Serialize for FaultKind {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_u8(self.number())
    }
}

impl<'de> Deserialize<'de> for FaultKind {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let number = u8::deserialize(deserializer)?;
        Self::from_number(number.into())
            .ok_or_else(|| D::Error::custom(format!("no kind of fault has the number {number}")))
    }
}
