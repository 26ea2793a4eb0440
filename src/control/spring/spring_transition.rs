//! From one spring to another without a jump in torque: law, stiffness and damping of a new set point are gone over to.

use crate::control::signals::{Law, SetPoint};
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
        Self { joints, exact: share(law), stiffness, damping }
    }
}

/// Of the exact law.
fn share(law: Law) -> f64 {
    match law {
        Law::Report => 0.0,
        Law::Exact => 1.0,
    }
}

impl Spring {
    /// Moves all but the anchor by a part of the way.
    fn approach(&mut self, exact: f64, stiffness: &Matrix6<f64>, damping: f64, part: f64) {
        self.exact += (exact - self.exact) * part;
        self.stiffness += (stiffness - self.stiffness) * part;
        self.damping += (damping - self.damping) * part;
    }
}

/// Two equal first-order stages in a row, so that the torque does not even bend sharply, and a planner that sends a new
/// spring in every cycle is followed all the while. The spring itself goes over, and not its torque: between two
/// springs within the bound every one is within it.
#[derive(Clone, Debug)]
pub(crate) struct SpringTransition {
    /// What a stage moves by in a cycle.
    part: f64,
}

/// The two stages.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct SpringStages {
    first: Spring,
    second: Spring,
}

impl SpringTransition {
    /// Cycles a second.
    pub fn new(rate: f64) -> Self {
        Self { part: -(-1.0 / (STAGE * rate)).exp_m1() }
    }

    /// The spring of this cycle, on the way to that of `set_point`, whose anchor it has. Begins with it as it is.
    pub fn advance<'a>(&self, stages: &'a mut Option<SpringStages>, set_point: &SetPoint) -> &'a Spring {
        let begin = || {
            let spring = Spring::from(*set_point);
            SpringStages { first: spring, second: spring }
        };
        let SpringStages { first, second } = stages.get_or_insert_with(begin);
        first.approach(share(set_point.law), &set_point.stiffness, set_point.damping, self.part);
        second.approach(first.exact, &first.stiffness, first.damping, self.part);
        second.joints = set_point.joints;
        second
    }
}
