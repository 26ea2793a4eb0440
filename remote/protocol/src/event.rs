//! Event, type 3: something that happened to a finger.

use crate::bytes::{Bytes, Written};
use crate::error::{FieldError, within};
use crate::{DecodeError, Finger, MessageKind};

const LENGTH: usize = 64;
const KIND: MessageKind = MessageKind::Event;

/// Something that happened to a finger in one cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// The finger.
    pub finger: Finger,
    /// The number of the part that the kind concerns: joint 0 to 2, or tendon, motor, gauge or encoder 1 to 4. It is 0
    /// if the kind concerns no such part.
    pub part: u8,
    /// The number of the kind in docs/events.md, from 1.
    pub kind: u16,
    /// The number of this Event since the server's start, from 1. A gap shows lost events.
    pub number: u64,
    /// The number of the cycle.
    pub cycle: u64,
    /// The beginning of the cycle, ns, server's clock.
    pub begin: u64,
    /// The values that docs/events.md lists for the kind. A value may be NaN.
    pub values: [f64; 4],
}

impl Event {
    /// Decodes a payload.
    ///
    /// # Errors
    /// Returns what is wrong: the type, the version, the length, or the value of a field.
    pub fn decode(payload: &[u8]) -> Result<Self, DecodeError> {
        let bytes = Bytes::of_message(payload, KIND, LENGTH)?;
        bytes.has_length(KIND, LENGTH)?;
        let event = Self {
            finger: Finger::decode(bytes.u8(2)).map_err(|error| error.of(KIND))?,
            part: bytes.u8(3),
            kind: bytes.u16(4),
            number: bytes.u64(8),
            cycle: bytes.u64(16),
            begin: bytes.u64(24),
            values: bytes.f64s(32),
        };
        event.check().map_err(|error| error.of(KIND))?;
        Ok(event)
    }

    fn check(&self) -> Result<(), FieldError> {
        within("kind", u64::from(self.kind), 1, u64::from(u16::MAX))?;
        within("number", self.number, 1, u64::MAX)
    }

    /// Encodes the Event.
    ///
    /// # Errors
    /// Returns the field whose value the protocol does not allow, and the reason.
    pub fn encode(&self) -> Result<Vec<u8>, FieldError> {
        self.check()?;
        let mut to = Written::message(KIND, LENGTH);
        to.u8(self.finger.number()).u8(self.part).u16(self.kind).zeros(2);
        to.u64(self.number).u64(self.cycle).u64(self.begin).f64s(&self.values);
        Ok(to.finish())
    }
}
