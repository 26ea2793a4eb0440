//! A ring of blocks of bytes with one writer and any number of readers.
//!
//! The writer overwrites the oldest blocks, and does not know of any reader. Positions count words since the beginning,
//! and never decrease. Before the writer overwrites words, it stores the position up to which it will write. A reader
//! that has copied words reads that position afterwards, and discards its copy if the words may have changed
//! meanwhile. It then continues with the newest block.
//!
//! A reader does not trust the contents of the memory. Whatever they are, it neither panics nor reads beyond the ring.

use super::marks::MARKS;
use crate::realtime::atomics::{AtomicU64, Ordering, fence};

/// Words before the data: the positions of the writer.
pub const CONTROL_WORDS: usize = 8;

/// Position up to which the writer has begun to write.
const RESERVED: usize = 0;

/// Position up to which blocks are complete.
const PUBLISHED: usize = 1;

/// Position of the newest complete block.
const NEWEST: usize = 2;

/// Words of a block before its bytes: the number of bytes, and the marks, which are numbers that the caller chooses.
const BLOCK_HEADER: u64 = 1 + MARKS as u64;

/// Bytes of a word.
const WORD: usize = size_of::<u64>();

/// The writer's end. There must be only one for a memory.
pub struct BlockWriter<M> {
    memory: M,
    position: u64,
}

/// A reader's end.
pub struct BlockReader<M> {
    memory: M,
    position: u64,
}

/// What a reader has found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// The next block, with its marks.
    Block([u64; MARKS]),
    /// There is no further block yet.
    Nothing,
    /// The writer has overwritten the next block. The reader continues with the newest one.
    Overtaken,
    /// The memory has contents that no writer produces.
    Damaged,
}

/// Returns the data words of a memory.
fn data(memory: &[AtomicU64]) -> &[AtomicU64] {
    memory.get(CONTROL_WORDS..).unwrap_or_default()
}

/// Returns the word at a position.
fn word(data: &[AtomicU64], position: u64) -> &AtomicU64 {
    &data[(position % data.len() as u64) as usize]
}

/// Returns the number of words of a block with this number of bytes.
fn words(bytes: u64) -> u64 {
    BLOCK_HEADER + bytes.div_ceil(WORD as u64)
}

impl<M: AsRef<[AtomicU64]>> BlockWriter<M> {
    /// Creates the writer of an empty ring. All words of `memory` must be 0.
    pub fn new(memory: M) -> Self {
        Self { memory, position: 0 }
    }

    /// Returns the memory.
    pub fn memory(&self) -> &M {
        &self.memory
    }

    /// Returns the position of the next block.
    pub fn position(&self) -> u64 {
        self.position
    }

    /// Writes a block. Returns false, and writes nothing, if the block is larger than the ring.
    pub fn write(&mut self, marks: [u64; MARKS], bytes: &[u8]) -> bool {
        let memory = self.memory.as_ref();
        let data = data(memory);
        let (start, end) = (self.position, self.position + words(bytes.len() as u64));
        if end - start > data.len() as u64 {
            return false;
        }
        memory[RESERVED].store(end, Ordering::Relaxed);
        // A reader that sees one of the new words also sees the new reserved position, and discards its copy.
        fence(Ordering::Release);
        let header = [bytes.len() as u64].into_iter().chain(marks);
        let (chunks, rest) = bytes.as_chunks::<WORD>();
        let mut last = [0; WORD];
        last[..rest.len()].copy_from_slice(rest);
        let last = (!rest.is_empty()).then_some(last);
        let content = chunks.iter().copied().chain(last).map(u64::from_le_bytes);
        for (position, value) in (start..end).zip(header.chain(content)) {
            word(data, position).store(value, Ordering::Relaxed);
        }
        memory[NEWEST].store(start, Ordering::Relaxed);
        memory[PUBLISHED].store(end, Ordering::Release);
        self.position = end;
        true
    }
}

impl<M: AsRef<[AtomicU64]>> BlockReader<M> {
    /// Creates a reader that begins with the block at `position`. Returns none if the memory is too small for a ring.
    pub fn new(memory: M, position: u64) -> Option<Self> {
        (memory.as_ref().len() > CONTROL_WORDS).then_some(Self { memory, position })
    }

    /// Reads the next block into `bytes`. The contents of `bytes` are valid only if the result is a block.
    pub fn read(&mut self, bytes: &mut Vec<u8>) -> Found {
        bytes.clear();
        let memory = self.memory.as_ref();
        let data = data(memory);
        let capacity = data.len() as u64;
        let published = memory[PUBLISHED].load(Ordering::Acquire);
        match published.checked_sub(self.position) {
            None => return Found::Damaged,
            Some(0) => return Found::Nothing,
            Some(ahead) if ahead > capacity => return self.overtaken(),
            Some(_) => {}
        }
        let at = |offset: u64| word(data, self.position.wrapping_add(offset)).load(Ordering::Relaxed);
        let length = at(0);
        let marks = std::array::from_fn(|mark| at(1 + mark as u64));
        if self.is_overwritten(capacity) {
            return self.overtaken();
        }
        // A block is not larger than the ring, and does not end after the published position.
        if length > capacity * WORD as u64 || words(length) > published - self.position {
            return Found::Damaged;
        }
        for offset in BLOCK_HEADER..words(length) {
            bytes.extend_from_slice(&at(offset).to_le_bytes());
        }
        bytes.truncate(length as usize);
        if self.is_overwritten(capacity) {
            return self.overtaken();
        }
        self.position += words(length);
        Found::Block(marks)
    }

    /// Returns whether words of the next block that were read before this call may have been overwritten.
    fn is_overwritten(&self, capacity: u64) -> bool {
        fence(Ordering::Acquire);
        self.memory.as_ref()[RESERVED].load(Ordering::Relaxed).saturating_sub(self.position) > capacity
    }

    fn overtaken(&mut self) -> Found {
        self.position = self.memory.as_ref()[NEWEST].load(Ordering::Relaxed);
        // The writer has published all blocks before the newest one. The fence makes sure that the next load of the
        // published position does not return a position before the newest block.
        fence(Ordering::Acquire);
        Found::Overtaken
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn memory(words: usize) -> Vec<AtomicU64> {
        (0..CONTROL_WORDS + words).map(|_| AtomicU64::new(0)).collect()
    }

    /// The bytes of a block, which show its number and their places.
    fn block(number: u64, length: usize) -> Vec<u8> {
        (0..length).map(|place| (number as usize * 31 + place) as u8).collect()
    }

    proptest! {
        #[test]
        fn blocks_arrive_whole_in_order_or_are_skipped(
            steps in prop::collection::vec((any::<bool>(), 0_usize..150), 1..200),
        ) {
            let memory = memory(64);
            let mut writer = BlockWriter::new(&memory[..]);
            let mut reader = BlockReader::new(&memory[..], 0).expect("a ring");
            let (mut written, mut lengths, mut bytes, mut next) = (0, vec![], Vec::new(), 0);
            for (writes, length) in steps {
                if writes {
                    prop_assert!(writer.write([written, 2 * written, 0], &block(written, length)));
                    lengths.push(length);
                    written += 1;
                    continue;
                }
                match reader.read(&mut bytes) {
                    Found::Block([number, double, _]) => {
                        prop_assert!(number >= next && double == 2 * number);
                        prop_assert_eq!(&bytes, &block(number, lengths[number as usize]));
                        next = number + 1;
                    }
                    Found::Nothing => prop_assert_eq!(next, written),
                    Found::Overtaken => next = written - 1,
                    Found::Damaged => prop_assert!(false, "damaged"),
                }
            }
        }

        #[test]
        fn no_contents_of_the_memory_make_a_reader_panic(
            contents in prop::collection::vec(prop_oneof![any::<u64>(), 0_u64..100], 0..80),
            position in prop_oneof![any::<u64>(), 0_u64..100],
        ) {
            let memory: Vec<AtomicU64> = contents.into_iter().map(AtomicU64::new).collect();
            if let Some(mut reader) = BlockReader::new(&memory[..], position) {
                let mut bytes = Vec::new();
                for _ in 0..20 {
                    reader.read(&mut bytes);
                    prop_assert!(bytes.len() <= memory.len() * WORD);
                }
            }
        }
    }

    #[test]
    fn a_block_larger_than_the_ring_is_not_written() {
        let memory = memory(16);
        let mut writer = BlockWriter::new(&memory[..]);
        assert!(!writer.write([0; MARKS], &[0; 8 * 16]));
        assert!(writer.write([0; MARKS], &[0; 8 * 12]));
        assert_eq!(writer.position(), 16);
    }
}
