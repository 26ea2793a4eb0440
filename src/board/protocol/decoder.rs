//! Decodes the bytes from the wire into frames.

use super::packet::MAX_FRAME;
use super::{MAX_WIRE, Packet};

/// Counts of what a decoder has received.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DecoderCounters {
    /// Bytes received.
    pub bytes: u64,
    /// Frames with a correct check.
    pub frames: u64,
    /// Pieces between two delimiters that were not valid frames: damaged, incomplete or too long.
    pub damaged: u64,
}

/// Finds frames in a stream of bytes. A damaged frame is lost. If its delimiter was damaged, the next frame is lost
/// too.
#[derive(Clone, Debug)]
pub struct Decoder {
    stuffed: [u8; MAX_WIRE],
    stuffed_length: usize,
    frame: [u8; MAX_FRAME],
    counters: DecoderCounters,
}

impl Default for Decoder {
    fn default() -> Self {
        Self { stuffed: [0; MAX_WIRE], stuffed_length: 0, frame: [0; MAX_FRAME], counters: DecoderCounters::default() }
    }
}

impl Decoder {
    /// Consumes `bytes` from the front until a valid frame is complete. Returns `None` if all bytes are consumed and no
    /// valid frame is complete.
    pub fn next(&mut self, bytes: &mut &[u8]) -> Option<Packet<'_>> {
        let mut frame_length = None;
        while let Some((&byte, rest)) = bytes.split_first() {
            *bytes = rest;
            frame_length = self.take(byte);
            if frame_length.is_some() {
                break;
            }
        }
        frame_length.and_then(|length| Packet::unchecked(&self.frame[..length]))
    }

    /// Discards an incomplete frame and counts it as damaged. The next byte begins a new one.
    pub fn abandon(&mut self) {
        let begun = std::mem::take(&mut self.stuffed_length) > 0;
        self.counters.damaged += u64::from(begun);
    }

    /// Returns the counts since the decoder was created.
    pub fn counters(&self) -> DecoderCounters {
        self.counters
    }

    /// Consumes one byte. Returns the length of the frame if this byte completed one.
    fn take(&mut self, byte: u8) -> Option<usize> {
        self.counters.bytes += 1;
        if byte != 0 {
            if let Some(room) = self.stuffed.get_mut(self.stuffed_length) {
                *room = byte;
            }
            // A length of one byte more than the buffer means that the frame is too long. The length stays at this
            // value until the delimiter.
            self.stuffed_length = (self.stuffed_length + 1).min(MAX_WIRE + 1);
            return None;
        }
        let length = std::mem::take(&mut self.stuffed_length);
        if length == 0 {
            // Two consecutive delimiters: the sender is resynchronising.
            return None;
        }
        let frame_length = self.unstuff(length);
        match frame_length {
            Some(_) => self.counters.frames += 1,
            None => self.counters.damaged += 1,
        }
        frame_length
    }

    fn unstuff(&mut self, length: usize) -> Option<usize> {
        let stuffed = self.stuffed.get(..length)?;
        let length = cobs::decode(stuffed, &mut self.frame).ok()?.frame_size();
        let frame = self.frame.get(..length)?;
        Packet::checked(frame).map(|_| length)
    }
}
