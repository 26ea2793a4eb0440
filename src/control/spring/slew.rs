//! Slew limit of the set point: a step becomes a straight line in joint space at a limited speed.
//!
//! Without this limit, a fingertip would be far from the anchor of its spring after a large step, and would not move
//! straight to the anchor. Joint 2 might straighten on the way. J is singular while joint 2 is straight, and the spring
//! has no torque to bend the joint again.

use nalgebra::Vector3;

/// Limit of the speed of every joint of the set point.
#[derive(Clone, Debug)]
pub(crate) struct Slew {
    /// Largest step of a joint, rad per cycle.
    step: f64,
}

impl Slew {
    /// Constructs the limit from a speed, rad/s, and the rate, Hz.
    pub fn new(speed: f64, rate: f64) -> Self {
        Self { step: speed / rate }
    }

    /// Moves `anchor` by one cycle toward `target`, both in rad.
    #[inline]
    pub fn advance(&self, anchor: &mut Vector3<f64>, target: &Vector3<f64>) {
        let way = target - *anchor;
        let farthest = way.amax();
        *anchor = if farthest > self.step { *anchor + way * (self.step / farthest) } else { *target };
    }

    /// Returns the step by which the next cycle moves `anchor` toward `target`, rad.
    pub fn next_step(&self, anchor: &Vector3<f64>, target: &Vector3<f64>) -> Vector3<f64> {
        let mut next = *anchor;
        self.advance(&mut next, target);
        next - anchor
    }
}
