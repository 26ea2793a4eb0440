//! The numbers that a block carries besides its bytes. They are in a file of their own, because the package in
//! `models/` checks blocks with fewer numbers.

/// Number of these numbers: one for each finger.
pub const MARKS: usize = 3;
