//! The limits of the motion on a path.

/// Limits of the derivatives of a joint angle, in this order: rate (rad/s), acceleration (rad/s^2) and jerk (rad/s^3).
#[derive(Clone, Copy, Debug)]
pub struct MotionLimits(pub [f64; 3]);
