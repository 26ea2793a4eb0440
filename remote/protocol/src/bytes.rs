//! Reading and writing of numbers at the offsets that docs/remote-protocol.md gives.

use crate::{DecodeError, MessageKind, VERSION};

/// The bytes of a message, or of a part of it. The offsets are those of docs/remote-protocol.md.
#[derive(Clone, Copy)]
pub(crate) struct Bytes<'a>(pub &'a [u8]);

impl<'a> Bytes<'a> {
    /// Checks type and version, and that at least the fixed fields are there.
    pub fn of_message(payload: &'a [u8], kind: MessageKind, fixed: usize) -> Result<Self, DecodeError> {
        let &[found, version, ..] = payload else { return Err(DecodeError::Short(payload.len())) };
        if found != kind as u8 {
            return Err(DecodeError::Kind { expected: kind, found });
        }
        if version != VERSION {
            return Err(DecodeError::Version { found: version });
        }
        if payload.len() < fixed {
            return Err(DecodeError::Length { kind, expected: fixed, found: payload.len() });
        }
        Ok(Self(payload))
    }

    /// Checks that the message has exactly this length.
    pub fn has_length(self, kind: MessageKind, expected: usize) -> Result<(), DecodeError> {
        let found = self.0.len();
        if found == expected { Ok(()) } else { Err(DecodeError::Length { kind, expected, found }) }
    }

    /// The bytes of a part of the message. The caller has checked the length of the message.
    pub fn from(self, at: usize, length: usize) -> Self {
        Self(&self.0[at..at + length])
    }

    fn array<const N: usize>(self, at: usize) -> [u8; N] {
        std::array::from_fn(|index| self.0[at + index])
    }

    pub fn u8(self, at: usize) -> u8 {
        self.0[at]
    }

    pub fn u16(self, at: usize) -> u16 {
        u16::from_le_bytes(self.array(at))
    }

    pub fn u32(self, at: usize) -> u32 {
        u32::from_le_bytes(self.array(at))
    }

    pub fn u64(self, at: usize) -> u64 {
        u64::from_le_bytes(self.array(at))
    }

    pub fn f64(self, at: usize) -> f64 {
        f64::from_le_bytes(self.array(at))
    }

    pub fn f64s<const N: usize>(self, at: usize) -> [f64; N] {
        std::array::from_fn(|index| self.f64(at + 8 * index))
    }
}

/// The bytes of a message that is being written.
pub(crate) struct Written(Vec<u8>);

impl Written {
    pub fn message(kind: MessageKind, length: usize) -> Self {
        let mut bytes = Vec::with_capacity(length);
        bytes.extend([kind as u8, VERSION]);
        Self(bytes)
    }

    pub fn bytes(&mut self, bytes: &[u8]) -> &mut Self {
        self.0.extend_from_slice(bytes);
        self
    }

    pub fn u8(&mut self, value: u8) -> &mut Self {
        self.bytes(&[value])
    }

    pub fn u16(&mut self, value: u16) -> &mut Self {
        self.bytes(&value.to_le_bytes())
    }

    pub fn u32(&mut self, value: u32) -> &mut Self {
        self.bytes(&value.to_le_bytes())
    }

    pub fn u64(&mut self, value: u64) -> &mut Self {
        self.bytes(&value.to_le_bytes())
    }

    pub fn f64s(&mut self, values: &[f64]) -> &mut Self {
        values.iter().for_each(|value| self.0.extend_from_slice(&value.to_le_bytes()));
        self
    }

    /// Writes zeros.
    pub fn zeros(&mut self, count: usize) -> &mut Self {
        self.0.resize(self.0.len() + count, 0);
        self
    }

    pub fn finish(self) -> Vec<u8> {
        self.0
    }
}
