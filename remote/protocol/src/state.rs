//! State, message type 2: the cycles of the fingers since the previous State.

use crate::bytes::{Bytes, Written};
use crate::error::{FieldError, Reason, within};
use crate::{DecodeError, FINGERS, MessageKind, Record};

/// The largest number of records of a State.
pub const MOST_RECORDS: usize = 300;

const FIXED: usize = 32;
const KIND: MessageKind = MessageKind::State;

/// The cycles of the fingers since the previous State. A finger that has stopped has one record in each State, with its
/// newest cycle. Cycles can be absent: `missing` is their number.
#[derive(Clone, Debug, PartialEq)]
pub struct State {
    /// Number of cycles that are missing before this State, because the server was late or their values were not
    /// finite.
    pub missing: u32,
    /// The number of this State. The next State has the next number.
    pub number: u64,
    /// Time of publication, ns, server's clock.
    pub time: u64,
    /// The number of the owner's epoch; 0 if there is no owner.
    pub owner: u64,
    /// The cycles. The cycles of each finger are in the order of their numbers.
    pub records: Vec<Record>,
}

impl State {
    /// Decodes a payload.
    ///
    /// # Errors
    /// Returns what is wrong: the type, the version, the length, or the value of a field.
    pub fn decode(payload: &[u8]) -> Result<Self, DecodeError> {
        let bytes = Bytes::of_message(payload, KIND, FIXED)?;
        let count = usize::from(bytes.u16(2));
        within("number of records", count as u64, 0, MOST_RECORDS as u64).map_err(|error| error.of(KIND))?;
        bytes.has_length(KIND, FIXED + count * Record::LENGTH)?;
        let records = (0..count).map(|number| {
            let record = Record::decode(bytes.from(FIXED + number * Record::LENGTH, Record::LENGTH));
            record.map_err(|error| error.within("record", number))
        });
        let records = records.collect::<Result<Vec<_>, _>>().map_err(|error| error.of(KIND))?;
        let state =
            Self { missing: bytes.u32(4), number: bytes.u64(8), time: bytes.u64(16), owner: bytes.u64(24), records };
        state.check_order().map_err(|error| error.of(KIND))?;
        Ok(state)
    }

    /// Checks the number of records, and the order of the cycles of each finger.
    fn check_order(&self) -> Result<(), FieldError> {
        within("number of records", self.records.len() as u64, 0, MOST_RECORDS as u64)?;
        let mut newest = [None; FINGERS];
        for (number, record) in self.records.iter().enumerate() {
            let before = newest[record.finger.index()].replace(record.cycle);
            if before.is_some_and(|before| before >= record.cycle) {
                return Err(FieldError::new(
                    "number of the cycle",
                    Reason::NotRising("the previous record of this finger"),
                )
                .within("record", number));
            }
        }
        Ok(())
    }

    /// Encodes the State.
    ///
    /// # Errors
    /// Returns the field whose value the protocol does not allow, and the reason.
    pub fn encode(&self) -> Result<Vec<u8>, FieldError> {
        self.check_order()?;
        for (number, record) in self.records.iter().enumerate() {
            record.check().map_err(|error| error.within("record", number))?;
        }
        let mut to = Written::message(KIND, FIXED + self.records.len() * Record::LENGTH);
        to.u16(self.records.len() as u16).u32(self.missing).u64(self.number).u64(self.time).u64(self.owner);
        self.records.iter().for_each(|record| record.encode(&mut to));
        Ok(to.finish())
    }
}
