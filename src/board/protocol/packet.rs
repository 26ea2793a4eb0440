//! A frame without its byte stuffing: header, sequence number, body and check.

use crc::{CRC_32_ISO_HDLC, Crc};

/// The length of the longest frame before byte stuffing: header, sequence number, body, check.
pub const MAX_FRAME: usize = 128;

/// The number of bytes that byte stuffing and the delimiter add to a frame. Byte stuffing adds only one byte, because
/// no frame is longer than 254 bytes.
pub const WIRE_OVERHEAD: usize = 2;

/// The length of the longest frame on the wire, with its delimiter.
pub const MAX_WIRE: usize = MAX_FRAME + WIRE_OVERHEAD;

/// Length of header and sequence number.
pub(super) const PREFIX: usize = 2;

/// Length of the check.
pub(super) const CHECK: usize = 4;

/// The CRC-32 of zlib and Ethernet, which every language and many microcontrollers provide.
static CHECKSUM: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// Computes the check, which is the CRC-32 of a frame's header, sequence number and body.
pub fn check(bytes: &[u8]) -> u32 {
    CHECKSUM.checksum(bytes)
}

/// A view of the bytes of a frame without their stuffing. The check of the frame is correct. The content of the frame
/// has not been read yet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Packet<'a> {
    prefix: [u8; PREFIX],
    body: &'a [u8],
}

impl<'a> Packet<'a> {
    /// Checks the bytes of a frame without their stuffing, and creates a view of them. Returns `None` if there are too
    /// few bytes or the check is wrong.
    pub fn checked(bytes: &'a [u8]) -> Option<Self> {
        let (content, sent) = bytes.split_last_chunk::<CHECK>()?;
        (check(content) == u32::from_le_bytes(*sent)).then(|| Self::unchecked(bytes)).flatten()
    }

    /// Creates a view of bytes whose check is known to be correct.
    pub(super) fn unchecked(bytes: &'a [u8]) -> Option<Self> {
        let (content, _) = bytes.split_last_chunk::<CHECK>()?;
        let (prefix, body) = content.split_first_chunk::<PREFIX>()?;
        Some(Self { prefix: *prefix, body })
    }

    /// Returns the frame type, 0 to 15: the high half of the header.
    pub fn kind(&self) -> u8 {
        self.prefix[0] >> 4
    }

    /// Returns the finger's address: the low half of the header.
    pub fn address(&self) -> u8 {
        self.prefix[0] & 0x0F
    }

    /// Returns the sequence number.
    pub fn sequence(&self) -> u8 {
        self.prefix[1]
    }

    /// Returns the bytes between sequence number and check.
    pub fn body(&self) -> &'a [u8] {
        self.body
    }
}
