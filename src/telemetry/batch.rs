//! Messages on their way into the ring: they are encoded one after the other, and written in blocks.

use super::block_ring::BlockWriter;
use super::marks::MARKS;
use super::memory_file::Mapping;
use super::message::Outgoing;

/// Size at which the messages are written as a block, bytes. With larger blocks, a slow reader would have less time
/// before the writer overwrites the block that the reader needs next.
const BLOCK: usize = 64 * 1024;

/// Room for one message, bytes. The largest messages are keyframes and controllers, with less than 10 kB.
const LARGEST_MESSAGE: usize = 32 * 1024;

/// Messages that have been encoded and not written yet.
pub(super) struct Batch {
    bytes: Vec<u8>,
    /// Number of bytes in use.
    used: usize,
    /// Number of cycles of each finger before these messages. It includes cycles that were lost.
    before: [u64; MARKS],
    /// The same number after these messages.
    after: [u64; MARKS],
}

impl Batch {
    pub fn new() -> Self {
        Self { bytes: vec![0; BLOCK + LARGEST_MESSAGE], used: 0, before: [0; MARKS], after: [0; MARKS] }
    }

    /// Counts cycles of a finger that are in the next message or lost. Here the first finger has the number 0.
    pub fn count(&mut self, finger: usize, cycles: u64) {
        self.after[finger] += cycles;
    }

    /// Adds a message. A message that is too large is dropped. This library makes no such message.
    pub fn add(&mut self, message: &Outgoing, ring: &mut BlockWriter<Mapping>) {
        let added = postcard::to_slice(message, &mut self.bytes[self.used..]).map(|bytes| bytes.len());
        self.used += added.unwrap_or(0);
        if self.used >= BLOCK {
            self.write(ring);
        }
    }

    /// Writes the messages as a block, if there are any. Returns whether a block was written.
    pub fn write(&mut self, ring: &mut BlockWriter<Mapping>) -> bool {
        let any = self.used > 0 && ring.write(self.before, &self.bytes[..self.used]);
        (self.used, self.before) = (0, self.after);
        any
    }
}
