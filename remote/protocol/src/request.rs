//! Request, type 5.

use crate::bytes::{Bytes, Written};
use crate::error::{FieldError, Reason};
use crate::{Action, DecodeError, Finger, MessageKind};

const LENGTH: usize = 16;
const KIND: MessageKind = MessageKind::Request;
const TAKE_OVER: u8 = 1;
const RECOVER: u8 = 2;

/// A request of a client.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Request {
    /// What is requested. It must agree with the action in the Zenoh key of the request.
    pub action: Action,
    /// The finger. `None` means every finger. Calibrate and identify need a finger. Acquire and release need `None`.
    pub finger: Option<Finger>,
    /// Whether to take the hand over from another owner. Only with acquire.
    pub take_over: bool,
    /// Whether to recover the fingers that have stopped. Only with acquire.
    pub recover: bool,
    /// The epoch: the random number that the server gave to the owner. Acquire and stop ignore it.
    pub epoch: u64,
}

impl Request {
    /// Decodes a payload.
    ///
    /// # Errors
    /// Returns what is wrong: the type, the version, the length, or the value of a field.
    pub fn decode(payload: &[u8]) -> Result<Self, DecodeError> {
        let bytes = Bytes::of_message(payload, KIND, LENGTH)?;
        bytes.has_length(KIND, LENGTH)?;
        Self::fields(bytes).map_err(|error| error.of(KIND))
    }

    fn fields(bytes: Bytes<'_>) -> Result<Self, FieldError> {
        let bits = bytes.u8(4);
        if bits & !(TAKE_OVER | RECOVER) != 0 {
            return Err(FieldError::new("bits", Reason::Bits(bits)));
        }
        let request = Self {
            action: Action::decode(bytes.u8(2))?,
            finger: match bytes.u8(3) {
                0 => None,
                number => Some(Finger::decode(number)?),
            },
            take_over: bits & TAKE_OVER != 0,
            recover: bits & RECOVER != 0,
            epoch: bytes.u64(8),
        };
        request.check()?;
        Ok(request)
    }

    fn check(&self) -> Result<(), FieldError> {
        let finger = |reason| Err::<(), _>(FieldError::new("finger", reason));
        match (self.action, self.finger) {
            (Action::Calibrate | Action::Identify, None) => {
                finger(Reason::Contradicts("the action, which needs the number of a finger"))?;
            }
            (Action::Acquire | Action::Release, Some(_)) => {
                finger(Reason::Contradicts("the action, which is for every finger"))?;
            }
            _ => {}
        }
        if self.action != Action::Acquire && self.bits() != 0 {
            return Err(FieldError::new("bits", Reason::Bits(self.bits())));
        }
        Ok(())
    }

    fn bits(&self) -> u8 {
        (if self.take_over { TAKE_OVER } else { 0 }) | (if self.recover { RECOVER } else { 0 })
    }

    /// Encodes the Request.
    ///
    /// # Errors
    /// Returns the field whose value the protocol does not allow, and the reason.
    pub fn encode(&self) -> Result<Vec<u8>, FieldError> {
        self.check()?;
        let mut to = Written::message(KIND, LENGTH);
        to.u8(self.action as u8).u8(self.finger.map_or(0, Finger::number)).u8(self.bits()).zeros(3).u64(self.epoch);
        Ok(to.finish())
    }
}
