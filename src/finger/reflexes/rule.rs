//! A reflex: a condition, and the reaction to it.

use crate::finger::events::EventKind;
use crate::model::FingerNumber;
use nalgebra::{Matrix3, Vector3};

/// A rule of a finger. It acts while the finger follows set points ([`Stage::Running`](crate::Stage::Running)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reflex {
    /// What the rule reacts to.
    pub condition: Condition,
    /// What the finger does.
    pub reaction: Reaction,
    /// If several rules fire in one cycle, the one with the highest priority reacts first. The others wait for the next
    /// cycles.
    pub priority: u8,
    /// Time after a reaction in which the rule does not fire again, s, 0 to 3600. A rule whose condition stays true
    /// fires again after this time. If the time is 0, the condition must become false before the rule fires again.
    pub refractory: f64,
    /// Time after a reaction in which the finger does not follow set points of its planner, s, 0 to 3600.
    pub inhibition: f64,
}

/// What a rule reacts to.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Condition {
    /// An event of this finger.
    Event(EventKind),
    /// An event of another finger of the hand.
    OtherFinger {
        /// The other finger.
        finger: FingerNumber,
        /// The event.
        event: EventKind,
    },
    /// The force of the surroundings on the tip is above this value, N.
    ForceAbove(f64),
    /// The tension of any tendon is above this value, N.
    TensionAbove(f64),
    /// The tension of any tendon is below this value, N.
    TensionBelow(f64),
    /// The angle of a joint is above a value.
    JointAbove {
        /// The joint, 0 to 2.
        joint: usize,
        /// The angle, rad.
        angle: f64,
    },
    /// The angle of a joint is below a value.
    JointBelow {
        /// The joint, 0 to 2.
        joint: usize,
        /// The angle, rad.
        angle: f64,
    },
    /// The board has not replied for this time, s.
    LinkLost(f64),
    /// The planner has sent no set point for this time, s. A set point counts even if the finger does not follow it
    /// because of an inhibition. A set point that is discarded because it was sent before a recovery, a calibration or
    /// a reaction does not count.
    PlannerSilent(f64),
}

/// What a finger does when a rule fires. The set point of a reaction is in force until the planner sends another one,
/// or until the planner's last set point would have expired. A path or a motion in progress ends.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Reaction {
    /// The finger stops with a fault: its motors enter the end state.
    Stop,
    /// The anchor of the spring (the joint angles of the set point) moves to the present joint angles.
    Hold,
    /// The spring gets this Kx, N/cm, and the damping ratio 1.
    Soften(Matrix3<f64>),
    /// The anchor of the spring moves to these joint angles, rad.
    Retract(Vector3<f64>),
    /// The tip presses harder in one direction: `direction`, or, if that is zero, the direction in which the spring
    /// presses now. If the spring presses with less than 0.05 N in this direction, the anchor stays where it is. The
    /// anchor also stays if Kx, or the Jacobian at the anchor, has no inverse.
    Grip {
        /// The direction in the finger's frame, for example the inward normal of the object at the tip. Its length does
        /// not matter. If it is zero, the direction in which the spring presses now is used.
        direction: Vector3<f64>,
        /// Increase of the force, N.
        by: f64,
        /// Largest force, N.
        most: f64,
    },
    /// The spring gets this damping ratio, or the nearest one that its stiffness admits.
    Damp(f64),
}
