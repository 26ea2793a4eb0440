//! The rate from which state feedback has all its parts.

/// Rate from which state feedback predicts oscillating disturbances, makes the spring stiffer during a fast motion, and
/// holds the dither of the tensions back while a burst waits, Hz. The files of these parts say what each of them would
/// do at 500 Hz.
pub(super) const FULL_RATE: f64 = 750.0;
