//! The set point as the finger follows it: a step becomes a straight line in joint space at a bounded speed.
//!
//! The tip of a spring let go far from its anchor does not go straight there. Joint 2 may be thrown straight on the
//! way, where J is singular and the spring has no torque left to bend it again.

use nalgebra::Vector3;

/// Bound on the speed of every joint of the set point.
#[derive(Clone, Debug)]
pub(crate) struct Slew {
    /// rad a cycle.
    step: f64,
}

impl Slew {
    /// `speed`: rad/s.
    pub fn new(speed: f64, rate: f64) -> Self {
        Self { step: speed / rate }
    }

    /// Moves `anchor` one cycle toward `target`, rad.
    pub fn advance(&self, anchor: &mut Vector3<f64>, target: &Vector3<f64>) {
        let way = target - *anchor;
        let farthest = way.amax();
        *anchor = if farthest > self.step { *anchor + way * (self.step / farthest) } else { *target };
    }
}
