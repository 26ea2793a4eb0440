//! Tells work that cannot be done without memory that there is none, before it begins: in the middle of it a failed
//! allocation would end the process, and with it a hand in motion.

use std::hint::black_box;

/// Small enough that the C library takes it from its heap. A larger one would change how it serves the planner later.
const BLOCK_BYTES: usize = 64 * 1024;

/// Whether the allocator has so much memory to give at this moment, in blocks of 64 KiB. Nothing keeps it from being
/// taken by others afterwards.
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
    // The compiler would leave out allocations of which nothing is used.
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
