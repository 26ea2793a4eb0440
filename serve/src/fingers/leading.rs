//! The lead: how far a set point may be ahead of its finger (see [`crate::lead`]).

use super::Fingers;
use crate::goal::{Destination, Goal, matrix};
use crate::lead::admitted_part;
use sun2xp::finger::FingerReport;
use sun2xp::hand::Ranges;
use sun2xp::motion::Pose;
use sun2xp::nalgebra::Vector3;
use sun2xp::{FingerNumber, HandError};

/// A set point on the way to a destination is not sent if all of its joint angles differ from those of the set point in
/// force by less than this, rad.
const SMALLEST_STEP: f64 = 1e-4;

/// A place that may be sent as a set point.
#[derive(Clone, Copy)]
pub(super) struct LedPlace {
    /// The place as it is sent.
    pub pose: Pose,
    /// The joint angles at this place, rad.
    joints: Vector3<f64>,
}

impl LedPlace {
    /// Whether a set point with these joint angles, rad, is almost at this place.
    pub fn is_near(&self, set_point: &Vector3<f64>) -> bool {
        (self.joints - set_point).amax() < SMALLEST_STEP
    }
}

impl Fingers {
    /// Returns the goal of a finger that is about to get a command. If the owner has not commanded a place for the
    /// finger, the set point in force is kept. A finger that was caught (see [`crate::silence`]) returns to the set
    /// point from before the catch.
    pub(super) fn keeping(&self, number: i32, goal: Goal, report: &FingerReport) -> Result<Goal, HandError> {
        let mut keeping = goal;
        if goal.destination == Destination::None {
            match goal.kept.filter(|_| report.expired) {
                // The kept place can be the pose that the finger had when it began to follow set points. This pose can
                // be slightly beyond a limit.
                Some(place) => keeping.destination = Destination::Joints(self.clamped(number, &place.into())?.into()),
                None => keeping.kept = Some(report.set_point.joints),
            }
        }
        Ok(keeping)
    }

    /// Returns the goal of a finger whose Kx is about to be sent. If the owner has not commanded the place of the
    /// finger, the new Kx pulls the finger to the set point in force. If this set point is farther ahead of the finger
    /// than the lead admits, it becomes the destination, so that the lead bounds the force.
    pub(super) fn pulled(&self, number: i32, goal: Goal, report: &FingerReport) -> Result<Goal, HandError> {
        if goal.destination != Destination::None {
            return Ok(goal);
        }
        let mut pulled = goal;
        (pulled.destination, pulled.whole) = (Destination::Joints(report.set_point.joints), false);
        let (_, whole) = self.led(number, &pulled, report)?;
        Ok(if whole { goal } else { pulled })
    }

    /// Returns the farthest place that the lead admits on the way to the destination, and whether this place is the
    /// destination itself.
    pub(super) fn led(
        &self,
        number: i32,
        goal: &Goal,
        report: &FingerReport,
    ) -> Result<(Option<LedPlace>, bool), HandError> {
        let (Destination::Joints(end) | Destination::Tip(end)) = goal.destination else { return Ok((None, true)) };
        let part = self.admitted(number, goal, report, &end);
        let joints = report.cycle.joints;
        // The finger can be slightly beyond a limit. A set point on the way must not be.
        let on_the_way = |part: f64| self.clamped(number, &(joints + (end - joints) * part).into());
        let place: [f64; 3] = if part < 1.0 { on_the_way(part)? } else { end.into() };
        let pose = match goal.destination {
            Destination::Tip(_) => Pose::Tip(self.hand.tip_at(number, place)?),
            _ => Pose::Joints(place),
        };
        Ok((Some(LedPlace { pose, joints: place.into() }), part >= 1.0))
    }

    /// Returns how far the lead admits a set point on the way from the finger to `end`, rad. 0 is at the finger, and 1
    /// at `end`.
    pub(super) fn admitted(&self, number: i32, goal: &Goal, report: &FingerReport, end: &Vector3<f64>) -> f64 {
        let joints = report.cycle.joints;
        let jacobian = self.hand.jacobian(number, Some(joints.into()));
        match (goal.spring, jacobian) {
            (Some((kx, _)), Ok(jacobian)) => admitted_part(&matrix(&jacobian), &kx, &joints, end, self.lead_force),
            // Without a measured pose or a Kx, the lead admits no part of the way.
            _ => 0.0,
        }
    }

    /// Returns the joint angles, rad, that the hand uses if `joints` are sent: they are within the limits. Returns none
    /// if the hand refuses `joints`. In that case the caller sends `joints` to the hand without the bound of the lead,
    /// and the hand refuses them with the reason. This function uses the hand's own check. With a stricter check, it
    /// would return none for some angles that the hand accepts, and these would be sent without the bound.
    pub(super) fn within_limits(
        &self,
        finger: FingerNumber,
        joints: &[f64; 3],
    ) -> Result<Option<Vector3<f64>>, HandError> {
        let limits = self.hand.limits(finger.get())?;
        let joint_limits = (limits.joint_minimum.into(), limits.joint_maximum.into());
        let (stiffness_bound, out_of_range) = (limits.stiffness, self.out_of_range);
        Ok(Ranges { finger, joint_limits, stiffness_bound, out_of_range }.joints(*joints).ok())
    }

    /// Returns the nearest joint angles within the limits, rad.
    fn clamped(&self, number: i32, joints: &[f64; 3]) -> Result<[f64; 3], HandError> {
        let limits = self.hand.limits(number)?;
        let (low, high) = (limits.joint_minimum, limits.joint_maximum);
        Ok(std::array::from_fn(|joint| joints[joint].clamp(low[joint], high[joint])))
    }
}
