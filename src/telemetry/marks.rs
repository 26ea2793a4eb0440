//! Marks: the numbers that a block carries besides its bytes. Their count is in a file of its own, because the package
//! in `models/` replaces this file in order to check blocks with fewer marks.

/// Number of marks in a block: one for each finger.
pub const MARKS: usize = 3;
