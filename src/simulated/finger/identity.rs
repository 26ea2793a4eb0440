//! What a simulated finger is known by.

pub(super) const SHORTEST_WATCHDOG_MS: u16 = 2;

/// Where the number of the board is in the unique number.
pub(super) const BOARD_NUMBER: std::ops::Range<usize> = 6..10;

/// Of a finger, 0 to 2, with this address. Two built-in boards may have one address, so it has both.
pub(super) fn unique_number(index: usize, address: u8) -> [u8; 12] {
    let mut number = *b"sun2xp\0\0\0\0\0\0";
    // The index is at most 2.
    number[BOARD_NUMBER.end..].copy_from_slice(&[index as u8 + 1, address]);
    number
}
