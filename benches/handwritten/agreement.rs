//! Compares the motor torques of the library's step with those of the handwritten step.

/// The larger number. Returns NaN if one of the numbers is NaN, which `f64::max` ignores.
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

/// Returns the largest difference between the two torques of a motor, relative to the largest torque in `theirs`.
/// Returns NaN if a torque is NaN.
pub fn apart(ours: &[f64; 4], theirs: &[f64; 4]) -> f64 {
    let apart = ours.iter().zip(theirs).map(|(ours, theirs)| (ours - theirs).abs()).fold(0.0, larger);
    let largest = theirs.iter().map(|torque| torque.abs()).fold(0.0, larger);
    // If all torques are zero, the quotient would be 0 / 0.
    if apart == 0.0 { 0.0 } else { apart / largest }
}
