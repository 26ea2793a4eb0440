//! The rule for finger numbers: a call that can act on all fingers accepts SUN2XP_ALL_FINGERS.

use crate::hand::Hand;
use std::ffi::c_int;

/// Stands for all fingers of a hand. Only the calls whose entries say so accept this number.
pub const SUN2XP_ALL_FINGERS: c_int = 0;

/// The fingers that `number` names. SUN2XP_ALL_FINGERS names all fingers that the hand has. Any other number is
/// returned unchecked: a later call of the hand refuses it if there is no such finger.
pub(super) fn fingers(hand: &Hand, number: c_int) -> impl Iterator<Item = c_int> + use<> {
    let all = number == SUN2XP_ALL_FINGERS;
    let one = (!all).then_some(number);
    hand.fingers().numbers().filter(move |_| all).chain(one)
}
