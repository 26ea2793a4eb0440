//! Status, type 4: the status of a hand and of its server.

use crate::bytes::{Bytes, Written};
use crate::error::{FieldError, Reason, finite, within};
use crate::{ClientName, DecodeError, FINGERS, Finger, FingerStatus, MessageKind};

const KIND: MessageKind = MessageKind::Status;
const RECORDS: usize = 112;
const NAME: usize = RECORDS + FINGERS * FingerStatus::LENGTH;

/// What the server counts, since its start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Targets that were taken.
    pub taken: u64,
    /// Messages that were malformed.
    pub malformed: u64,
    /// Targets of an old epoch.
    pub old_epoch: u64,
    /// Targets that were replayed.
    pub replayed: u64,
    /// Targets that were too old.
    pub late: u64,
    /// Targets that the hand did not admit.
    pub refused: u64,
    /// How often the fingers were caught (held softly in their poses), because the validity of the newest Target had
    /// ended.
    pub caught: u64,
    /// How often the fingers went to their end state because the owner fell silent.
    pub ended: u64,
}

/// The status of a hand and of its server. The server publishes it once a second.
#[derive(Clone, Debug, PartialEq)]
pub struct Status {
    /// `catch_ms` of the server, ms: at least 1.
    pub catch_ms: u32,
    /// `end_ms` of the server, ms: at least 1.
    pub end_ms: u32,
    /// Number of clients that have sent a permitted Request since the start.
    pub clients: u32,
    /// Time, ns, server's clock.
    pub time: u64,
    /// Rate of the servos, Hz.
    pub rate: f64,
    /// `lead_force` of the server, N.
    pub lead_force: f64,
    /// `soft_stiffness` of the server, N/cm.
    pub soft_stiffness: f64,
    /// What the server counts.
    pub counts: Counts,
    /// Fingers 1 to 3; none for a finger that the hand does not have.
    pub fingers: [Option<FingerStatus>; FINGERS],
    /// The owner; none if nobody owns the hand.
    pub owner: Option<ClientName>,
}

impl Status {
    /// Decodes a payload.
    ///
    /// # Errors
    /// Returns what is wrong: the type, the version, the length, or the value of a field.
    pub fn decode(payload: &[u8]) -> Result<Self, DecodeError> {
        let bytes = Bytes::of_message(payload, KIND, NAME + 1)?;
        let name = usize::from(bytes.u8(NAME));
        bytes.has_length(KIND, NAME + 1 + name)?;
        Self::fields(bytes, bytes.from(NAME + 1, name).0).map_err(|error| error.of(KIND))
    }

    fn fields(bytes: Bytes<'_>, name: &[u8]) -> Result<Self, FieldError> {
        let mut fingers = [const { None }; FINGERS];
        let has = bytes.u8(2);
        if has > 0b111 {
            return Err(FieldError::new("bits", Reason::Bits(has)));
        }
        for finger in Finger::ALL {
            let record = bytes.from(RECORDS + finger.index() * FingerStatus::LENGTH, FingerStatus::LENGTH);
            if has >> finger.index() & 1 == 1 {
                let decoded = FingerStatus::decode(record);
                fingers[finger.index()] = Some(decoded.map_err(|error| error.within("record", finger.index()))?);
            } else if record.0.iter().any(|&byte| byte != 0) {
                return Err(FieldError::new("status of the finger", Reason::NotZero).within("record", finger.index()));
            }
        }
        let owner = match name {
            [] => None,
            name => Some(owner(name)?),
        };
        let [taken, malformed, old_epoch, replayed, late, refused, caught, ended] =
            std::array::from_fn(|count| bytes.u64(48 + 8 * count));
        let status = Self {
            catch_ms: bytes.u32(4),
            end_ms: bytes.u32(8),
            clients: bytes.u32(12),
            time: bytes.u64(16),
            rate: bytes.f64(24),
            lead_force: bytes.f64(32),
            soft_stiffness: bytes.f64(40),
            counts: Counts { taken, malformed, old_epoch, replayed, late, refused, caught, ended },
            fingers,
            owner,
        };
        status.check()?;
        Ok(status)
    }

    fn check(&self) -> Result<(), FieldError> {
        within("catch_ms", u64::from(self.catch_ms), 1, u64::from(u32::MAX))?;
        within("end_ms", u64::from(self.end_ms), 1, u64::from(u32::MAX))?;
        for (field, number) in [("rate", self.rate), ("lead_force", self.lead_force)] {
            finite(field, &[number])?;
            if number <= 0.0 {
                return Err(FieldError::new(field, Reason::NotPositive(number)));
            }
        }
        finite("soft_stiffness", &[self.soft_stiffness])?;
        if self.soft_stiffness < 0.0 {
            return Err(FieldError::new("soft_stiffness", Reason::Negative(self.soft_stiffness)));
        }
        for (number, finger) in self.fingers.iter().enumerate() {
            let checked = finger.as_ref().map_or(Ok(()), FingerStatus::check);
            checked.map_err(|error| error.within("record", number))?;
        }
        Ok(())
    }

    /// Encodes the Status.
    ///
    /// # Errors
    /// Returns the field whose value the protocol does not allow, and the reason.
    pub fn encode(&self) -> Result<Vec<u8>, FieldError> {
        self.check()?;
        let name = self.owner.as_ref().map_or("", ClientName::as_str);
        let has = (0..FINGERS).map(|index| u8::from(self.fingers[index].is_some()) << index).sum();
        let mut to = Written::message(KIND, NAME + 1 + name.len());
        to.u8(has).zeros(1).u32(self.catch_ms).u32(self.end_ms).u32(self.clients).u64(self.time);
        to.f64s(&[self.rate, self.lead_force, self.soft_stiffness]);
        let counts = &self.counts;
        to.u64(counts.taken).u64(counts.malformed).u64(counts.old_epoch).u64(counts.replayed);
        to.u64(counts.late).u64(counts.refused).u64(counts.caught).u64(counts.ended);
        for finger in &self.fingers {
            match finger {
                Some(finger) => finger.encode(&mut to),
                None => {
                    to.zeros(FingerStatus::LENGTH);
                }
            }
        }
        to.u8(name.len() as u8).bytes(name.as_bytes());
        Ok(to.finish())
    }
}

fn owner(name: &[u8]) -> Result<ClientName, FieldError> {
    let text = std::str::from_utf8(name).map_err(|_| FieldError::new("owner's name", Reason::NotText))?;
    text.parse().map_err(|_| FieldError::new("owner's name", Reason::NotAName))
}
