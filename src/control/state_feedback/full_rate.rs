//! The rate from which state feedback uses all of its functions.

/// Rate, Hz, from which state feedback predicts oscillating disturbances, makes the spring stiffer during a fast
/// motion, and does not raise the dither of the tensions while a burst of dither is delayed (`dither_burst.rs`). The
/// files of these functions say what each of them would do at 500 Hz.
pub(super) const FULL_RATE: f64 = 750.0;
