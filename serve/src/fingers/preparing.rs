//! Prepares the new parts of a Target that has arrived. No finger gets its part until all parts are prepared, because
//! the server applies all of them or none.

use super::Fingers;
use crate::goal::{Destination, Goal, is_path, rows};
use sun2xp::groups::FingerCommand;
use sun2xp::hand::plan_path;
use sun2xp::motion::{PathPose, Pose, Validity};
use sun2xp::nalgebra::Vector3;
use sun2xp::{FingerNumber, HandError, Stage};
use sun2xp_remote_protocol::{Part, Place};

/// A prepared part of a Target: the new goal of its finger, the finger's command in the group that the hand gets, and
/// the poses of the path.
pub(super) struct Prepared {
    pub finger: usize,
    pub goal: Goal,
    /// None if the hand needs nothing but the path, or nothing at all.
    pub command: Option<FingerCommand>,
    pub path: Vec<PathPose>,
}

impl Fingers {
    /// Prepares a new part.
    pub(super) fn prepare(&self, part: &Part, valid: Validity, now: u64) -> Result<Prepared, HandError> {
        let (finger, number) = (part.finger.index(), i32::from(part.finger.number()));
        let report = self.hand.report(number)?;
        let known = FingerNumber::try_from(number)?;
        match report.stage {
            Stage::Running => {}
            Stage::Faulted(fault) => return Err(HandError::Faulted { finger: known, fault }),
            Stage::Limp => return Err(HandError::Limp(known)),
            // The servo discards a part that was prepared before the finger begins to follow set points.
            _ => return Err(HandError::Busy(known)),
        }
        let mut path = Vec::new();
        let destination = match &part.place {
            Place::Kept => None,
            Place::Joints(joints) => Some(Destination::Joints(Vector3::from(*joints))),
            Place::Tip(tip) => Some(Destination::Tip(self.hand.joints_at(number, *tip)?.into())),
            Place::Path(poses) => {
                path.extend(poses.iter().map(|pose| PathPose {
                    time: pose.time,
                    pose: Pose::Joints(pose.joints),
                    stiffness: None,
                }));
                let plan = plan_path(&self.hand.configuration(), known, &report.reference, &path)?;
                let until = |pose: &sun2xp_remote_protocol::PathPose| now.saturating_add(nanoseconds(pose.time));
                poses.last().map(|pose| Destination::Path { end: plan.end(), until: until(pose) })
            }
        };
        let mut before = self.goals[finger];
        before.notice(&report);
        let mut goal = before.with(part, destination, &report, now);
        if !is_path(part) && report.expired && matches!(goal.destination, Destination::Path { .. }) {
            goal.destination = Destination::None; // The times of an interrupted path are in the past.
        }
        goal = self.keeping(number, goal, &report)?;
        let mut command = FingerCommand::new(number).validity(valid);
        (command.stiffness, command.damping) = (part.stiffness, part.damping);
        if let Place::Joints(joints) = &part.place {
            match self.within_limits(known, joints)? {
                Some(admitted) => goal.destination = Destination::Joints(admitted),
                // The angles are out of range. The hand refuses the group, and gives the reason.
                None => command.pose = Some(Pose::Joints(*joints)),
            }
        }
        if goal.destination == Destination::None && (part.stiffness.is_some() || report.expired) {
            goal = self.pulled(number, goal, &report)?;
        }
        if command.pose.is_none() {
            let (place, whole) = self.led(number, &goal, &report)?;
            (command.pose, goal.whole) = (place.map(|place| place.pose), whole);
        }
        if let Some((kx, damping)) = goal.spring.filter(|_| report.expired) {
            // The finger was caught (see `crate::silence`): it holds its pose with a soft spring. The command restores
            // the spring that the owner wants.
            (command.stiffness, command.damping) = (Some(rows(&kx)), Some(damping));
        }
        let empty = command.pose.is_none() && command.stiffness.is_none() && command.damping.is_none();
        Ok(Prepared { finger, goal, command: (!empty).then_some(command), path })
    }
}

/// A time in ns. The conversion saturates.
fn nanoseconds(seconds: f64) -> u64 {
    (seconds * 1e9) as u64
}
