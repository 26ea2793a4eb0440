//! Answer, type 6.

use crate::bytes::{Bytes, Written};
use crate::error::{FieldError, Reason, within};
use crate::{Code, DecodeError, MessageKind};

const FIXED: usize = 34;
const KIND: MessageKind = MessageKind::Answer;

/// The answer to a Request, or the refusal of a Target.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answer {
    /// Whether the action is done, or why it is not.
    pub code: Code,
    /// `catch_ms` of the server, ms: the longest validity that it gives to a Target. At least 1.
    pub catch_ms: u32,
    /// For an acquire that is done: the new epoch. Otherwise: the epoch of the Request or Target. It is 0 if an
    /// acquire is refused, if the Request is malformed or has another version, and if its sender is not permitted.
    pub epoch: u64,
    /// Time, ns, server's clock: a value for [`Target::seen`](crate::Target::seen).
    pub time: u64,
    /// For the refusal of a Target: its sequence number. For an acquire that is done: the public number by which the
    /// server counts the new epoch (the epoch itself is random and secret). It is higher than the number of every
    /// earlier epoch. States show it as [`State::owner`](crate::State::owner). Otherwise 0.
    pub number: u64,
    /// The cause and the remedy; empty if the code is [`Code::Done`].
    pub text: String,
}

impl Answer {
    /// Decodes a payload.
    ///
    /// # Errors
    /// Returns what is wrong: the type, the version, the length, or the value of a field.
    pub fn decode(payload: &[u8]) -> Result<Self, DecodeError> {
        let bytes = Bytes::of_message(payload, KIND, FIXED)?;
        let length = usize::from(bytes.u16(32));
        bytes.has_length(KIND, FIXED + length)?;
        let code = Code::decode(bytes.u16(2)).map_err(|error| error.of(KIND))?;
        let text = std::str::from_utf8(bytes.from(FIXED, length).0)
            .map_err(|_| FieldError::new("text", Reason::NotText).of(KIND))?;
        let answer = Self {
            code,
            catch_ms: bytes.u32(4),
            epoch: bytes.u64(8),
            time: bytes.u64(16),
            number: bytes.u64(24),
            text: text.into(),
        };
        answer.check().map_err(|error| error.of(KIND))?;
        Ok(answer)
    }

    fn check(&self) -> Result<(), FieldError> {
        within("catch_ms", u64::from(self.catch_ms), 1, u64::from(u32::MAX))?;
        if self.text.len() > usize::from(u16::MAX) {
            return Err(FieldError::new("text", Reason::TooLong(usize::from(u16::MAX))));
        }
        match self.code {
            Code::Done if !self.text.is_empty() => {
                Err(FieldError::new("text", Reason::Contradicts("the code, which is 0 (done)")))
            }
            _ => Ok(()),
        }
    }

    /// Encodes the Answer.
    ///
    /// # Errors
    /// Returns the field whose value the protocol does not allow, and the reason.
    pub fn encode(&self) -> Result<Vec<u8>, FieldError> {
        self.check()?;
        let mut to = Written::message(KIND, FIXED + self.text.len());
        to.u16(self.code as u16).u32(self.catch_ms).u64(self.epoch).u64(self.time).u64(self.number);
        to.u16(self.text.len() as u16).bytes(self.text.as_bytes());
        Ok(to.finish())
    }
}
