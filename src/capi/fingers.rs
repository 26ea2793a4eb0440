//! The rule for finger numbers: a call that can act on all fingers accepts SUN2XP_ALL_FINGERS.

use crate::hand::Hand;
use std::ffi::c_int;

/// All fingers of a hand. Only calls whose entries say so accept it.
pub const SUN2XP_ALL_FINGERS: c_int = 0;

/// The fingers that `number` names. SUN2XP_ALL_FINGERS names all fingers that the hand has. The hand refuses numbers
/// that do not exist.
pub(super) fn fingers(hand: &Hand, number: c_int) -> impl Iterator<Item = c_int> + use<> {
    let all = number == SUN2XP_ALL_FINGERS;
    let one = (!all).then_some(number);
    hand.fingers().numbers().filter(move |_| all).chain(one)
}
