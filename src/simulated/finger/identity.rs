//! Constants and the unique number of a simulated finger.

use crate::model::FingerNumber;

pub(super) const SHORTEST_WATCHDOG_MS: u16 = 2;

/// Bytes of the unique number that hold the number of the simulated board. They are 0 until `set_board_number` writes
/// them.
pub(super) const BOARD_NUMBER: std::ops::Range<usize> = 6..10;

/// Returns the unique number of a finger with this address. Fingers of two built-in boards may have the same address,
/// so the unique number contains the number of the finger too.
pub(super) fn unique_number(finger: FingerNumber, address: u8) -> [u8; 12] {
    let mut number = *b"sun2xp\0\0\0\0\0\0";
    number[BOARD_NUMBER.end..].copy_from_slice(&[finger.get() as u8, address]);
    number
}
