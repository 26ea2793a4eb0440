//! Transition from one spring to another without a jump in torque: law, stiffness and damping change gradually.

use crate::control::signals::{Law, SetPoint};
use crate::control::spring::joint_spring::JointSpring;
use nalgebra::{Matrix6, Vector3};
use serde::{Deserialize, Serialize};

/// Time constant of each of the two stages, s.
const STAGE: f64 = 0.01;

/// Stiffness, N cm/rad, and torque, N cm, below which a joint spring that ends is no longer computed.
const NEGLIGIBLE: f64 = 1e-9;

/// The spring of one cycle. It is the spring of a [`SetPoint`], or a spring between the springs of two set points.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct Spring {
    /// Anchor: the desired joint angles, rad.
    pub joints: Vector3<f64>,
    /// Share of [`Law::Exact`] in the deflection, 0 to 1. The rest is the share of [`Law::Report`].
    pub exact: f64,
    /// Stiffness, with the units and axes of [`SetPoint::stiffness`].
    pub stiffness: Matrix6<f64>,
    /// Relative damping, as in [`SetPoint::damping`].
    pub damping: f64,
}

impl From<SetPoint> for Spring {
    fn from(SetPoint { joints, law, stiffness, damping, .. }: SetPoint) -> Self {
        Self { joints, exact: share(law), stiffness, damping }
    }
}

/// Returns the share of [`Law::Exact`].
fn share(law: Law) -> f64 {
    match law {
        Law::Report => 0.0,
        Law::Exact => 1.0,
    }
}

impl Spring {
    /// Moves everything except the anchor toward the given values by the fraction `part` of the difference.
    #[inline]
    fn approach(&mut self, exact: f64, stiffness: &Matrix6<f64>, damping: f64, part: f64) {
        self.exact += (exact - self.exact) * part;
        self.stiffness += (stiffness - self.stiffness) * part;
        self.damping += (damping - self.damping) * part;
    }
}

/// Two equal first-order stages in series. With one stage the torque would have a kink. Unlike a ramp that starts again
/// with every command, the stages also follow a planner that sends a new spring in every cycle. The stages act on the
/// spring and not on its torque: if two springs are within the bound of the stiffness, every spring between them is
/// within this bound too.
#[derive(Clone, Debug)]
pub(crate) struct SpringTransition {
    /// Fraction of the remaining difference by which a stage moves in a cycle.
    part: f64,
}

/// The two stages.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct SpringStages {
    first: Spring,
    second: Spring,
    /// The two stages of the joint spring, if there is one.
    #[serde(default)]
    joint: Option<[JointSpring; 2]>,
}

impl SpringTransition {
    /// Constructs the transition for `rate`, Hz.
    pub fn new(rate: f64) -> Self {
        Self { part: -(-1.0 / (STAGE * rate)).exp_m1() }
    }

    /// Returns the springs of this cycle: the spring of the tip, and the joint spring if there is one. They approach
    /// the springs of `set_point` from cycle to cycle. Only the anchor is that of `set_point` at once. The first call
    /// starts with the springs of `set_point`.
    #[inline]
    pub fn advance<'a>(
        &self,
        stages: &'a mut Option<SpringStages>,
        set_point: &SetPoint,
    ) -> (&'a Spring, Option<&'a JointSpring>) {
        let begin = || {
            let spring = Spring::from(*set_point);
            SpringStages { first: spring, second: spring, joint: set_point.joint_spring.map(|joint| [joint; 2]) }
        };
        let SpringStages { first, second, joint } = stages.get_or_insert_with(begin);
        first.approach(share(set_point.law), &set_point.stiffness, set_point.damping, self.part);
        second.approach(first.exact, &first.stiffness, first.damping, self.part);
        second.joints = set_point.joints;
        if joint.is_some() || set_point.joint_spring.is_some() {
            self.advance_joint(joint, &set_point.joint_spring);
        }
        (second, joint.as_ref().map(|[_, second]| second))
    }

    /// Advances the joint spring. A spring that ends is removed when it is negligible.
    #[cold]
    fn advance_joint(&self, stages: &mut Option<[JointSpring; 2]>, target: &Option<JointSpring>) {
        let [first, second] = stages.get_or_insert_default();
        first.approach(&target.unwrap_or_default(), self.part);
        second.approach(first, self.part);
        if target.is_none() && first.is_below(NEGLIGIBLE) && second.is_below(NEGLIGIBLE) {
            *stages = None;
        }
    }
}
