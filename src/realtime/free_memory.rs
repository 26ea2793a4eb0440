//! A check for free memory before work that needs memory. A failed allocation in the middle of that work would end the
//! process while a hand may be in motion.

use std::hint::black_box;

/// Size of one block. A block is so small that the C library takes it from its heap. Freeing a larger block would
/// change how the C library serves the planner's later allocations.
const BLOCK_BYTES: usize = 64 * 1024;

/// Whether the allocator can provide `bytes` now, in blocks of 64 KiB. Other threads may take this memory afterwards.
pub fn is_memory_free(bytes: usize) -> bool {
    let count = bytes.div_ceil(BLOCK_BYTES);
    let mut blocks: Vec<Vec<u8>> = Vec::new();
    if blocks.try_reserve_exact(count).is_err() {
        return false;
    }
    let free = (0..count).all(|_| {
        let mut block = Vec::new();
        let free = block.try_reserve_exact(BLOCK_BYTES).is_ok();
        blocks.push(block);
        free
    });
    // The compiler would otherwise remove the allocations, because nothing uses them.
    black_box(&mut blocks);
    free
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn some_memory_is_free_and_not_all_addresses_are() {
        assert!(is_memory_free(1 << 20));
        assert!(!is_memory_free(1 << 60));
    }
}
