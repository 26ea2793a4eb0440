//! A frame on the wire: header, sequence number, body and check with byte stuffing, then a zero.

use super::fields::FieldWriter;
use super::message::Message;
use super::packet::{MAX_FRAME, MAX_WIRE, check};

/// A frame ready to be sent, with its delimiter.
#[derive(Clone, Copy, Debug)]
pub struct WireFrame {
    bytes: [u8; MAX_WIRE],
    length: usize,
}

impl WireFrame {
    /// Encodes a message: adds check, byte stuffing and delimiter.
    pub fn new(message: &Message) -> Self {
        let mut content = [0; MAX_FRAME];
        let mut fields = FieldWriter::new(&mut content);
        fields.u8((message.frame.kind() as u8) << 4 | message.address & 0x0F);
        fields.u8(message.sequence);
        message.frame.write(&mut fields);
        let check = check(fields.written());
        fields.u32(check);

        let mut bytes = [0; MAX_WIRE];
        // `cobs::encode` panics when the destination is too small; MAX_WIRE holds MAX_FRAME bytes stuffed.
        let stuffed = cobs::encode(fields.written(), &mut bytes);
        // The buffer was filled with zeros, so the delimiter is already there.
        Self { bytes, length: stuffed + 1 }
    }

    /// Returns the bytes to send.
    pub fn as_bytes(&self) -> &[u8] {
        &self.bytes[..self.length]
    }
}
