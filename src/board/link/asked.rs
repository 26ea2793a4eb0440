//! The properties of a request by which its answer is recognised.

use crate::board::protocol::{ANY_ADDRESS, Decoder, Frame, Message};

/// The bit that the type of an answer has in addition to the bits of the type of its request.
const ANSWER: u8 = 0x8;

/// A request whose answer is awaited.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asked {
    address: u8,
    sequence: u8,
    /// The type of the request.
    kind: u8,
}

impl Asked {
    pub fn by(request: &Message) -> Self {
        Self { address: request.address, sequence: request.sequence, kind: request.frame.kind() as u8 }
    }

    /// Reads the first frame of these bytes, which include delimiters. Returns none if there is no frame.
    pub fn on_wire(bytes: &[u8]) -> Option<Self> {
        let mut decoder = Decoder::default();
        let packet = decoder.next(&mut &*bytes)?;
        Some(Self { address: packet.address(), sequence: packet.sequence(), kind: packet.kind() })
    }

    /// Returns whether the message is the answer or the refusal of this request.
    pub fn is_answered_by(&self, message: &Message) -> bool {
        let answers = match message.frame {
            Frame::Refused(refused) => refused.request == self.kind,
            frame => frame.kind() as u8 == self.kind | ANSWER,
        };
        answers && message.sequence == self.sequence && (message.address == self.address || self.address == ANY_ADDRESS)
    }
}
