//! A frame without its byte stuffing: header, sequence number, body and check.

use crc::{CRC_32_ISO_HDLC, Crc};

/// The longest frame before byte stuffing: header, sequence number, body, check.
pub const MAX_FRAME: usize = 128;

/// What byte stuffing and the delimiter add. One byte each, because no frame is longer than 254 bytes.
pub const WIRE_OVERHEAD: usize = 2;

/// The longest frame on the wire, with its delimiter.
pub const MAX_WIRE: usize = MAX_FRAME + WIRE_OVERHEAD;

/// Header and sequence number.
pub(super) const PREFIX: usize = 2;

/// The check.
pub(super) const CHECK: usize = 4;

/// The check of zlib and Ethernet: every language has it, and so have many microcontrollers.
static CHECKSUM: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The check over header, sequence number and body.
pub fn check(bytes: &[u8]) -> u32 {
    CHECKSUM.checksum(bytes)
}

/// A frame whose check holds, before anyone looked at what it says: a view over its bytes without stuffing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Packet<'a> {
    prefix: [u8; PREFIX],
    body: &'a [u8],
}

impl<'a> Packet<'a> {
    /// None when the bytes are too few, or their check is wrong.
    pub fn checked(bytes: &'a [u8]) -> Option<Self> {
        let (content, sent) = bytes.split_last_chunk::<CHECK>()?;
        (check(content) == u32::from_le_bytes(*sent)).then(|| Self::unchecked(bytes)).flatten()
    }

    /// For bytes whose check has been seen to hold.
    pub(super) fn unchecked(bytes: &'a [u8]) -> Option<Self> {
        let (content, _) = bytes.split_last_chunk::<CHECK>()?;
        let (prefix, body) = content.split_first_chunk::<PREFIX>()?;
        Some(Self { prefix: *prefix, body })
    }

    /// The frame type, 0 to 15: the high half of the header.
    pub fn kind(&self) -> u8 {
        self.prefix[0] >> 4
    }

    /// The finger's address: the low half of the header.
    pub fn address(&self) -> u8 {
        self.prefix[0] & 0x0F
    }

    /// The sequence number.
    pub fn sequence(&self) -> u8 {
        self.prefix[1]
    }

    /// What lies between sequence number and check.
    pub fn body(&self) -> &'a [u8] {
        self.body
    }
}
