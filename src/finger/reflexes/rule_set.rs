//! All rules of a finger.

use super::rule::Reflex;

/// The largest number of rules of a finger. The servo evaluates all of them in every cycle.
pub const MOST_RULES: usize = 16;

/// The rules of a finger, each with its number.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rules(pub [Option<(u32, Reflex)>; MOST_RULES]);
