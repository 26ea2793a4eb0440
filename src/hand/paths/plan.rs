//! Computes a path from its poses.

use super::PathPose;
use super::limits::Excess;
use crate::control::motion::{PathExtent, PathTable, TimedStiffness};
use crate::control::{Law, SetPoint, spatial};
use crate::finger::{MOST_PIECES, MOST_POSES, Reference};
use crate::hand::admission::{Admission, DampingAdmission};
use crate::hand::{PathError, Pose, SetPointError};
use crate::model::FingerNumber;
use crate::model::configuration::{Configuration, OutOfRange};
use crate::model::path::{Knot, Piece, Start, spline};
use nalgebra::{Matrix6, Vector3};

/// Shortest time from one pose to the next, s.
const LEAST_STEP: f64 = 1e-3;

/// Rounding error of the time from one pose to the next, s. Poses that are exactly [`LEAST_STEP`] apart are accepted.
const TIME_ROUNDING: f64 = 1e-9;

/// Time in which a finger in motion brakes to rest if a path that continues its motion is refused, s.
const BRAKING: f64 = 0.15;

/// Longest path, s.
const LONGEST: f64 = 3600.0;

/// Factor by which a path that is too fast is made slower than necessary, so that it meets its limits despite rounding.
const MARGIN: f64 = 1.001;

/// Largest number of attempts to make a path slower. From rest one attempt is enough. If a path begins in motion, each
/// attempt changes its shape.
const ATTEMPTS: usize = 30;

/// Computes the path that finger `number` of a hand with this configuration would follow, and checks it. This function
/// is for tools that have no open hand.
///
/// # Errors
/// Returns the reason why the finger would refuse the path.
pub fn plan_path(
    configuration: &Configuration,
    number: FingerNumber,
    reference: &Reference,
    poses: &[PathPose],
) -> Result<Plan, PathError> {
    Admission::new(configuration, number).path(reference, poses)
}

/// A path that has been computed and checked.
pub struct Plan {
    pieces: Vec<Piece>,
    stiffness: Vec<TimedStiffness>,
    /// The law of the path.
    pub law: Law,
}

impl Plan {
    /// Returns the path as a servo follows it.
    pub fn table(&self) -> PathTable<'_> {
        PathTable { pieces: &self.pieces, stiffness: &self.stiffness }
    }

    /// Returns the joint angles at the end of the path, rad.
    pub fn end(&self) -> Vector3<f64> {
        self.pieces.last().map_or_else(Vector3::zeros, |last| last.at(last.end()).place)
    }

    /// Returns a function that changes a set point so that the finger follows the path. The function refuses a damping
    /// that is too high or too low for a Kx of the path, or clamps it.
    pub(in crate::hand) fn change(
        &self,
        damping: DampingAdmission,
    ) -> impl FnOnce(&mut SetPoint) -> Result<PathExtent, SetPointError> + use<> {
        let (along, end, law) = (self.stiffest_and_last(), self.end(), self.law);
        let (lowest, highest) = self.table().bounds();
        move |set_point: &mut SetPoint| {
            (set_point.joints, set_point.law) = (end, law);
            let begin = set_point.stiffness;
            for &stiffness in &along {
                set_point.stiffen_tip(stiffness);
                damping.admit(set_point)?;
            }
            let stiffest = along.first().map(|&first| damping.with_narrowest_range([first, begin])).transpose()?;
            Ok(PathExtent { lowest, highest, stiffest })
        }
    }

    /// Returns the stiffest Kx of the path, and then the last one. There is none if the path does not change Kx.
    fn stiffest_and_last(&self) -> Vec<Matrix6<f64>> {
        let largest = |one: &TimedStiffness| one.kx.symmetric_eigenvalues().max();
        let stiffest = self.stiffness.iter().max_by(|one, other| largest(one).total_cmp(&largest(other)));
        stiffest.into_iter().chain(self.stiffness.last()).map(|timed| spatial(&timed.kx)).collect()
    }
}

impl Admission {
    /// Computes the path from `reference` through `poses`, and checks it.
    ///
    /// A slow path that begins in motion may leave the joint limits: if a path takes 30 s to reduce an acceleration of
    /// 0.1 rad/s^2 to zero, the joint moves by several rad meanwhile. If the path that continues the motion is refused,
    /// a path that first brakes to rest is tried instead. If it is refused too, the first refusal is returned.
    pub fn path(&self, reference: &Reference, poses: &[PathPose]) -> Result<Plan, PathError> {
        self.direct_path(reference, poses).or_else(|refusal| self.path_after_braking(reference, poses).ok_or(refusal))
    }

    /// Computes a path that first brakes to rest within [`BRAKING`]. Returns none if `reference` is at rest, or if this
    /// path must be refused too.
    fn path_after_braking(&self, reference: &Reference, poses: &[PathPose]) -> Option<Plan> {
        let start = start_of(reference);
        if [start.rates, start.accelerations, start.jerk].iter().all(|derivative| derivative.amax() == 0.0) {
            return None;
        }
        // After a step of the set point, the filter of the set point can give the reference a large acceleration and
        // jerk, which decay by themselves. The path therefore begins with zero acceleration and jerk. The servo filters
        // the difference between the servo's reference and the beginning of the path.
        let start = Start { accelerations: Vector3::zeros(), jerk: Vector3::zeros(), ..start };
        // A constant deceleration to rest within BRAKING ends at this place.
        let place = start.place + start.rates * (BRAKING / 2.0);
        let mut pieces = spline(&start, &[Knot { time: BRAKING, place }]);
        self.check_joint_limits(&pieces, 1, &start.place).ok()?;
        if self.excess(&pieces, &start).is_some() {
            return None;
        }
        let rest = Reference { joints: place, ..Reference::default() };
        let earlier: Vec<_> = poses.iter().map(|pose| PathPose { time: pose.time - BRAKING, ..*pose }).collect();
        let Plan { pieces: mut later, mut stiffness, law } = self.direct_path(&rest, &earlier).ok()?;
        later.iter_mut().for_each(|piece| piece.begin += BRAKING);
        stiffness.iter_mut().for_each(|timed| timed.time += BRAKING);
        pieces.append(&mut later);
        (pieces.len() <= MOST_PIECES).then_some(Plan { pieces, stiffness, law })
    }

    /// Computes and checks a path that continues the motion of `reference`.
    fn direct_path(&self, reference: &Reference, poses: &[PathPose]) -> Result<Plan, PathError> {
        if !(1..=MOST_POSES).contains(&poses.len()) {
            let count = i64::try_from(poses.len()).unwrap_or(i64::MAX);
            return Err(PathError::Count { count, most: MOST_POSES });
        }
        let times = self.times(poses)?;
        self.check_kinds(poses)?;
        let mut stiffness = self.stiffness_along(poses)?;
        let start = start_of(reference);
        let law = if matches!(poses[0].pose, Pose::Tip(_)) { Law::Exact } else { self.law };
        let mut scale = 1.0;
        for _ in 0..ATTEMPTS {
            let scaled: Vec<f64> = times.iter().map(|time| time * scale).collect();
            let (pieces, per_pose) = self.pieces(&start, poses, &scaled)?;
            self.check_joint_limits(&pieces, per_pose, &start.place)?;
            match self.excess(&pieces, &start) {
                None => {
                    stiffness.iter_mut().for_each(|timed| timed.time *= scale);
                    return Ok(Plan { pieces, stiffness, law });
                }
                Some(excess) if self.out_of_range == OutOfRange::Refuse => {
                    return Err(self.too_fast(&excess, per_pose));
                }
                Some(Excess { factor, .. }) => scale *= factor * MARGIN,
            }
        }
        let (pieces, per_pose) = self.pieces(&start, poses, &times)?;
        match self.excess(&pieces, &start) {
            Some(excess) => Err(self.too_fast(&excess, per_pose)),
            None => Ok(Plan { pieces, stiffness, law }),
        }
    }

    /// Checks the times of the poses and returns them, s.
    fn times(&self, poses: &[PathPose]) -> Result<Vec<f64>, PathError> {
        let mut before = 0.0;
        for (pose, &PathPose { time, .. }) in poses.iter().enumerate() {
            // This form of the comparison rejects NaN.
            if !(time >= before + (LEAST_STEP - TIME_ROUNDING) && time <= LONGEST) {
                let (least, most) = (LEAST_STEP, LONGEST);
                return Err(PathError::Time { finger: self.finger, pose, time, before, least, most });
            }
            before = time;
        }
        Ok(poses.iter().map(|pose| pose.time).collect())
    }

    /// Refuses numbers that are not finite, and a mixture of joint angles and tip positions.
    fn check_kinds(&self, poses: &[PathPose]) -> Result<(), PathError> {
        let is_tip = |pose: &PathPose| matches!(pose.pose, Pose::Tip(_));
        for (index, pose) in poses.iter().enumerate() {
            let (Pose::Joints(place) | Pose::Tip(place)) = pose.pose;
            let kx = pose.stiffness.as_slice().as_flattened().as_flattened();
            let finite = self.finite("Place", &place).and_then(|()| self.finite("Kx", kx));
            finite.map_err(|source| in_pose(index, source))?;
            if is_tip(pose) != is_tip(&poses[0]) {
                return Err(PathError::Mixed { finger: self.finger, pose: index });
            }
        }
        Ok(())
    }

    /// Returns the stiffness along the path. It is empty if no pose has a stiffness. A Kx that is not symmetric or not
    /// positive semi-definite is refused before one that is too stiff, whichever pose comes first. So the order of the
    /// poses does not decide which of the two is reported.
    fn stiffness_along(&self, poses: &[PathPose]) -> Result<Vec<TimedStiffness>, PathError> {
        let mut along: Vec<TimedStiffness> = Vec::new();
        let mut too_stiff = None;
        for (index, pose) in poses.iter().enumerate() {
            match pose.stiffness.map(|rows| self.kx(rows)).transpose() {
                Ok(given) => along.extend(given.map(|kx| TimedStiffness { time: pose.time, kx })),
                Err(source @ SetPointError::TooStiff { .. }) => {
                    too_stiff = too_stiff.or(Some(in_pose(index, source)));
                }
                Err(source) => return Err(in_pose(index, source)),
            }
        }
        too_stiff.map_or(Ok(along), Err)
    }

    /// Computes the pieces, and the number of pieces for each pose.
    fn pieces(&self, start: &Start, poses: &[PathPose], times: &[f64]) -> Result<(Vec<Piece>, usize), PathError> {
        let (mut joints, mut tips) = (Vec::new(), Vec::new());
        for (pose, (given, &time)) in poses.iter().zip(times).enumerate() {
            match given.pose {
                Pose::Joints(angles) => {
                    let place = self.joints(angles).map_err(|source| in_pose(pose, source))?;
                    joints.push(Knot { time, place });
                }
                Pose::Tip(tip) => tips.push(Knot { time, place: tip.into() }),
            }
        }
        if tips.is_empty() { Ok((spline(start, &joints), 1)) } else { self.tip_pieces(start, &tips) }
    }
}

/// Returns the motion with which a path begins.
fn start_of(reference: &Reference) -> Start {
    let Reference { joints, motion, .. } = reference;
    Start { place: *joints, rates: motion.rates, accelerations: motion.accelerations, jerk: motion.jerk }
}

pub(super) fn in_pose(pose: usize, source: SetPointError) -> PathError {
    PathError::Pose { pose, on_the_way: false, source }
}
