//! Target, type 1: the set points of the owner.

use crate::bytes::{Bytes, Written};
use crate::error::{FieldError, Reason, within};
use crate::{DecodeError, FINGERS, MessageKind, Part};

/// The longest validity, ms.
pub const LONGEST_VALIDITY_MS: u32 = 60_000;

/// The largest number of parts of a Target.
pub const MOST_PARTS: usize = FINGERS;

const FIXED: usize = 40;
const KIND: MessageKind = MessageKind::Target;

/// The set points that are in force for the fingers of a hand.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// How long the Target is valid, ms: 1 to [`LONGEST_VALIDITY_MS`]. The server limits this time to its
    /// `catch_ms`.
    pub validity_ms: u32,
    /// The epoch of the owner.
    pub epoch: u64,
    /// The sequence number. It is higher than the sequence number of every earlier Target of this epoch.
    pub sequence: u64,
    /// The time at which the Target was sent, on any clock of the sender.
    pub sent: u64,
    /// The time, on the server's clock, of the newest State or Answer that the sender has received.
    pub seen: u64,
    /// The set points, in rising order of their fingers. Without parts, the Target only says that the owner
    /// is alive.
    pub parts: Vec<Part>,
}

impl Target {
    /// Decodes a payload.
    ///
    /// # Errors
    /// Returns what is wrong: the type, the version, the length, or the value of a field.
    pub fn decode(payload: &[u8]) -> Result<Self, DecodeError> {
        let bytes = Bytes::of_message(payload, KIND, FIXED)?;
        let count = usize::from(bytes.u8(2));
        within("number of parts", count as u64, 0, MOST_PARTS as u64).map_err(|error| error.of(KIND))?;
        let mut parts = Vec::with_capacity(count);
        let mut at = FIXED;
        let mut ranges = Vec::with_capacity(count);
        for _ in 0..count {
            if payload.len() < at + Part::FIXED {
                return Err(DecodeError::Length { kind: KIND, expected: at + Part::FIXED, found: payload.len() });
            }
            let length = Part::length_at(bytes.from(at, Part::FIXED));
            ranges.push((at, length));
            at += length;
        }
        bytes.has_length(KIND, at)?;
        for (number, (at, length)) in ranges.into_iter().enumerate() {
            let part = Part::decode(bytes.from(at, length));
            parts.push(part.map_err(|error| error.within("part", number).of(KIND))?);
        }
        let target = Self {
            validity_ms: bytes.u32(4),
            epoch: bytes.u64(8),
            sequence: bytes.u64(16),
            sent: bytes.u64(24),
            seen: bytes.u64(32),
            parts,
        };
        target.check_order().map_err(|error| error.of(KIND))?;
        Ok(target)
    }

    /// Checks the number and the order of the parts, and the validity.
    fn check_order(&self) -> Result<(), FieldError> {
        within("number of parts", self.parts.len() as u64, 0, MOST_PARTS as u64)?;
        within("validity", u64::from(self.validity_ms), 1, u64::from(LONGEST_VALIDITY_MS))?;
        for (number, pair) in self.parts.windows(2).enumerate() {
            if pair[1].finger <= pair[0].finger {
                return Err(
                    FieldError::new("finger", Reason::NotRising("the previous part")).within("part", number + 1)
                );
            }
        }
        Ok(())
    }

    /// Encodes the Target.
    ///
    /// # Errors
    /// Returns the field whose value the protocol does not allow, and the reason.
    pub fn encode(&self) -> Result<Vec<u8>, FieldError> {
        self.check_order()?;
        for (number, part) in self.parts.iter().enumerate() {
            part.check().map_err(|error| error.within("part", number))?;
        }
        let mut to = Written::message(KIND, FIXED + self.parts.iter().map(Part::length).sum::<usize>());
        to.u8(self.parts.len() as u8).zeros(1).u32(self.validity_ms);
        to.u64(self.epoch).u64(self.sequence).u64(self.sent).u64(self.seen);
        self.parts.iter().for_each(|part| part.encode(&mut to));
        Ok(to.finish())
    }
}
