//! Handles: how C programs name an open hand.
//!
//! A handle is a pointer by its type only. Its value contains a tag, the number of the hand among those that the
//! process has opened, and the place of the hand in the table. The number has 40 bits (16 on 32-bit machines), and
//! repeats after 2^40 (2^16) hands. Nothing dereferences a handle, so a null, foreign or closed one can be refused.

use std::ptr::without_provenance_mut;

/// An open hand. A program has only pointers to it.
// The C header gives the type this name.
#[allow(non_camel_case_types)]
#[repr(C)]
pub struct sun2xp_hand {
    _private: [u8; 0],
}

/// The value of a handle; 0 is the value of a null pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Handle(usize);

/// Largest number of hands, opened with sun2xp_open, that can be open at the same time.
pub(super) const MOST_HANDS: usize = 16;

/// The place of the hand of OpenHand in the table.
pub(super) const DEFAULT: usize = 0;

/// Number of places in the table: one for the hand of OpenHand, and one for each hand of sun2xp_open.
pub(super) const PLACES: usize = MOST_HANDS + 1;

/// Number of bits of the place in the table.
const PLACE_BITS: u32 = 8;

/// Number of bits of the tag. On 64-bit machines, no pointer to memory of a program has these bits set.
const TAG_BITS: u32 = usize::BITS / 4;

/// "Sx". On 32-bit machines only the last letter is left.
const TAG: usize = 0x5378 & ((1 << TAG_BITS) - 1);

impl Handle {
    pub const NULL: Self = Self(0);

    /// The handle of the hand with this number at this place of the table.
    pub fn new(number: usize, place: usize) -> Self {
        let number_bits = usize::BITS - TAG_BITS - PLACE_BITS;
        let number = number & ((1 << number_bits) - 1);
        Self(TAG << (usize::BITS - TAG_BITS) | number << PLACE_BITS | place)
    }

    /// Inlined into the exported functions. If they called this function instead, the compiler would assume that the
    /// call can unwind, and would give their frames a landing pad. If the thread is cancelled asynchronously, the
    /// unwinder ends the process at a landing pad.
    #[inline(always)]
    pub fn of(pointer: *const sun2xp_hand) -> Self {
        Self(pointer.addr())
    }

    /// Inlined for the same reason as [`Handle::of`].
    #[inline(always)]
    pub fn from_value(value: usize) -> Self {
        Self(value)
    }

    pub fn value(self) -> usize {
        self.0
    }

    pub fn to_c(self) -> *mut sun2xp_hand {
        without_provenance_mut(self.0)
    }

    /// The place that the handle names; none if it does not have the tag of a handle. The place may be beyond the
    /// table.
    pub fn place(self) -> Option<usize> {
        (self.0 >> (usize::BITS - TAG_BITS) == TAG).then_some(self.0 & ((1 << PLACE_BITS) - 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_handles_have_a_place() {
        let number = 7;
        assert_eq!(Handle::NULL.place(), None);
        assert_eq!(Handle::of((&raw const number).cast()).place(), None);
        let handle = Handle::new(number, 15);
        assert_eq!(Handle::of(handle.to_c()), handle);
        assert_eq!(handle.place(), Some(15));
        assert_ne!(handle, Handle::new(number + 1, 15));
    }
}
