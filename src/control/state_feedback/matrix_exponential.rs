//! Exact discretisation of the motion of a motor on its tendon.

use nalgebra::Matrix6;

/// Returns e^(A T) and the integral of e^(A s) over s from 0 to T. The Taylor series is computed for a part of T that
/// is short compared with the fastest motion in A. That part is then doubled until it is T.
pub(super) fn exponential(rates: &Matrix6<f64>, time: f64) -> (Matrix6<f64>, Matrix6<f64>) {
    // The fastest motion is the motor on its tendon: A(1, 0) = - omega^2.
    let turns = time * rates[(1, 0)].abs().sqrt();
    let doublings = (turns * 16.0).log2().ceil().clamp(6.0, 60.0) as i32;
    let part = time * 0.5f64.powi(doublings);
    let (mut whole, mut integral) = (Matrix6::identity(), Matrix6::identity() * part);
    let mut term = Matrix6::identity();
    for order in 1..12 {
        term = term * rates * (part / f64::from(order));
        whole += term;
        integral += term * (part / f64::from(order + 1));
    }
    for _ in 0..doublings {
        integral += whole * integral;
        whole *= whole;
    }
    (whole, integral)
}
