//! The one rule for the number of a finger: calls that can take all fingers take SUN2XP_ALL_FINGERS.

use crate::model::configuration::FINGERS;
use std::ffi::c_int;
use std::ops::RangeInclusive;

/// All fingers of a hand. Only calls whose entries say so accept it.
pub const SUN2XP_ALL_FINGERS: c_int = 0;

/// The fingers of a number that may be SUN2XP_ALL_FINGERS. The hand refuses numbers that do not exist.
pub(super) fn fingers(number: c_int) -> RangeInclusive<c_int> {
    if number == SUN2XP_ALL_FINGERS { 1..=FINGERS as c_int } else { number..=number }
}
