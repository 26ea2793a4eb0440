//! From one spring to another without a jump in torque: law, stiffness and damping of a new set point are gone over to.

use super::signals::{Law, SetPoint};
use nalgebra::{Matrix6, Vector3};
use serde::{Deserialize, Serialize};

/// Time constant of each of the two stages, s.
const STAGE: f64 = 0.01;

/// The spring of one cycle: a [`SetPoint`], or what is between two of them.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct Spring {
    /// Its anchor, rad.
    pub joints: Vector3<f64>,
    /// The share of the exact law in its deflection; the rest is the report's. 0 to 1.
    pub exact: f64,
    /// As that of a set point.
    pub stiffness: Matrix6<f64>,
    /// As that of a set point.
    pub damping: f64,
}

impl From<SetPoint> for Spring {
    fn from(SetPoint { joints, law, stiffness, damping }: SetPoint) -> Self {
        let exact = match law {
            Law::Report => 0.0,
            Law::Exact => 1.0,
        };
        Self { joints, exact, stiffness, damping }
    }
}

impl Spring {
    /// Moves all but the anchor toward `target` by a part of the way.
    fn approach(&mut self, target: &Self, part: f64) {
        self.exact += (target.exact - self.exact) * part;
        self.stiffness += (target.stiffness - self.stiffness) * part;
        self.damping += (target.damping - self.damping) * part;
    }
}

/// Two equal first-order stages in a row, so that the torque does not even bend sharply, and a planner that sends a new spring in
/// every cycle is followed all the while. The spring itself goes over, and not its torque: between two springs within the bound
/// every one is within it.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(super) struct SpringTransition {
    first: Spring,
    second: Spring,
}

impl SpringTransition {
    /// Begins with a spring as it is.
    pub fn new(spring: Spring) -> Self {
        Self { first: spring, second: spring }
    }

    /// The spring of this cycle, on the way to `target`. Its anchor is that of `target`.
    pub fn advance(&mut self, target: &Spring, period: f64) -> Spring {
        let part = -(-period / STAGE).exp_m1();
        self.first.approach(target, part);
        self.second.approach(&self.first, part);
        Spring { joints: target.joints, ..self.second }
    }
}
