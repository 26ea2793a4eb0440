//! Checks of `src/telemetry/block_ring.rs` with one writer and one reader.

use super::block_ring::{BlockReader, BlockWriter, CONTROL_WORDS, Found};
use crate::realtime::atomics::AtomicU64;
use crate::spawn;
use std::sync::Arc;

/// Number of blocks that the writer writes. The ring has room for one.
const BLOCKS: u64 = 2;

/// Number of words of a block with eight bytes: one word for the number of bytes, one for the mark, one for the bytes.
const BLOCK_WORDS: usize = 3;

#[derive(Clone)]
struct Memory(Arc<[AtomicU64]>);

impl AsRef<[AtomicU64]> for Memory {
    fn as_ref(&self) -> &[AtomicU64] {
        &self.0
    }
}

fn take(reader: &mut BlockReader<Memory>, arrived: &mut Vec<u64>) -> Found {
    let mut bytes = Vec::new();
    let found = reader.read(&mut bytes);
    assert_ne!(found, Found::Damaged, "the reader mixed the positions of different blocks");
    if let Found::Block([mark]) = found {
        let value = u64::from_le_bytes(bytes.try_into().expect("parts of different blocks"));
        assert_eq!(value, mark, "parts of different blocks");
        arrived.push(mark);
    }
    found
}

/// A reader of a ring that is overwritten receives whole blocks in order. It always receives the newest one.
pub fn blocks_are_whole_and_the_newest_arrives() {
    let memory = Memory((0..CONTROL_WORDS + BLOCK_WORDS).map(|_| AtomicU64::new(0)).collect());
    let mut reader = BlockReader::new(memory.clone(), 0).expect("a ring");
    let mut writer = BlockWriter::new(memory);
    let writing = spawn(move || {
        for number in 1..=BLOCKS {
            assert!(writer.write([number], &number.to_le_bytes()));
        }
    });
    let mut arrived = Vec::new();
    take(&mut reader, &mut arrived);
    take(&mut reader, &mut arrived);
    writing.join().expect("no panic");
    while take(&mut reader, &mut arrived) != Found::Nothing {}
    assert!(arrived.is_sorted_by(|before, after| before < after), "{arrived:?}");
    assert_eq!(arrived.last(), Some(&BLOCKS), "{arrived:?}");
}
