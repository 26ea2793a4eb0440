//! The box A^-1, which the report left out: joint angles for a fingertip position, in closed form.

use crate::model::Links;
use nalgebra::Vector3;
use std::f64::consts::PI;
use thiserror::Error;

/// So far beyond a joint limit, rad, a solution is at the limit: the rounding of a tip kept as `float`. Its tip is less
/// than a hundredth of a millimetre away.
const LIMIT_ROUNDING: f64 = 1e-5;

/// A tip so near to the axis of joint 0, cm, leaves its angle open: the present one is kept.
const ON_THE_AXIS: f64 = 1e-9;

/// Part of the links' lengths by which rounding may put a tip outside of what they reach.
const REACH_ROUNDING: f64 = 1e-9;

/// A^-1 of Figure 9 for one finger within its joint limits.
#[derive(Clone, Debug)]
pub struct InverseKinematics {
    links: Links,
    low: Vector3<f64>,
    high: Vector3<f64>,
}

/// A tip position that the finger does not reach.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum OutOfReach {
    /// Beyond the outstretched finger.
    #[error(
        "this point is {distance:.3} cm from the axis of joint 1, and the outstretched finger reaches {reach:.3} cm. \
         Send a point that is nearer"
    )]
    TooFar {
        /// From the axis of joint 1 to the tip, cm.
        distance: f64,
        /// l1 + l2, cm.
        reach: f64,
    },
    /// Inside of what the folded finger reaches.
    #[error(
        "this point is {distance:.3} cm from the axis of joint 1, and the folded finger comes no nearer than \
         {least:.3} cm. Send a point that is farther away"
    )]
    TooNear {
        /// From the axis of joint 1 to the tip, cm.
        distance: f64,
        /// |l1 - l2|, cm.
        least: f64,
    },
    /// Every joint solution is outside the joint limits.
    #[error(
        "joint {joint} would have to be at {value:.4} rad, outside its limits of {low:.4} to {high:.4} rad, and every \
         other solution is farther outside. Send another point, or change `finger.joints`"
    )]
    BeyondLimits {
        /// The joint that is farthest outside, 0 to 2, of the solution that is least so.
        joint: usize,
        /// Its angle, rad.
        value: f64,
        /// Its lower limit, rad.
        low: f64,
        /// Its upper limit, rad.
        high: f64,
    },
}

impl InverseKinematics {
    /// `limits`: lower and upper joint limits, rad, within half a turn of zero.
    pub fn new(links: Links, limits: (Vector3<f64>, Vector3<f64>)) -> Self {
        Self { links, low: limits.0, high: limits.1 }
    }

    /// The joint angles, rad, within the limits, that put the tip at `tip` (cm, in the finger's frame): of several
    /// solutions the one whose farthest joint is nearest to `present`, so the one that the finger is at first.
    ///
    /// # Errors
    /// No solution at all, or none within the limits.
    pub fn joints(&self, tip: &Vector3<f64>, present: &Vector3<f64>) -> Result<Vector3<f64>, OutOfReach> {
        let way = |joints: &Vector3<f64>| (joints - present).amax();
        let nearer = |one: Vector3<f64>, other: Vector3<f64>| if way(&other) < way(&one) { other } else { one };
        let solutions = self.solutions(tip, present[0])?;
        let admitted = solutions.iter().flatten().filter(|joints| self.beyond(joints).1 <= LIMIT_ROUNDING);
        let limited = |joints: &Vector3<f64>| joints.sup(&self.low).inf(&self.high);
        match admitted.map(limited).reduce(nearer) {
            Some(joints) => Ok(joints),
            None => Err(self.refuse(tip, &solutions)),
        }
    }

    /// Every solution, rad, in -pi to pi, whatever the limits: joint 0 toward the tip or away from it (the finger then
    /// bends over its own base), each with both elbows. `open`: the angle of joint 0 for a tip on its axis.
    ///
    /// # Errors
    /// There is none.
    pub fn solutions(&self, tip: &Vector3<f64>, open: f64) -> Result<[Option<Vector3<f64>>; 4], OutOfReach> {
        let across = tip.x.hypot(tip.z);
        let toward = if across < ON_THE_AXIS { open } else { tip.x.atan2(tip.z) };
        let away = half_turn(toward + PI);
        let [one, other] = match (self.elbows(across, tip.y), self.elbows(-across, tip.y)) {
            // The way over the base is the farther one: it may serve where the tip is too near.
            (Err(refusal), Err(_)) => return Err(refusal),
            (one, other) => [one.ok(), other.ok()],
        };
        let with_base = |base: f64, elbow: (f64, f64)| Vector3::new(base, elbow.0, elbow.1);
        let [near, far] = [
            one.map(|elbows| elbows.map(|elbow| with_base(toward, elbow))),
            other.map(|elbows| elbows.map(|elbow| with_base(away, elbow))),
        ];
        let part = |pair: &Option<[Vector3<f64>; 2]>, index: usize| pair.as_ref().map(|pair| pair[index]);
        Ok([part(&near, 0), part(&near, 1), part(&far, 0), part(&far, 1)])
    }

    /// Joints 1 and 2 in the plane that joint 0 has turned: `reach` and `y` as the tip has them. The law of cosines.
    fn elbows(&self, reach: f64, y: f64) -> Result<[(f64, f64); 2], OutOfReach> {
        let [l0, l1, l2] = self.links.0;
        let (along, down) = (reach - l0, -y);
        let distance = along.hypot(down);
        let (longest, least) = (l1 + l2, (l1 - l2).abs());
        let rounding = REACH_ROUNDING * longest;
        if distance > longest + rounding {
            return Err(OutOfReach::TooFar { distance, reach: longest });
        }
        if distance < least - rounding {
            return Err(OutOfReach::TooNear { distance, least });
        }
        let cosine = ((distance * distance - l1 * l1 - l2 * l2) / (2.0 * l1 * l2)).clamp(-1.0, 1.0);
        let bent = cosine.acos();
        let elbow = |joint_2: f64| {
            let joint_1 = down.atan2(along) - (l2 * joint_2.sin()).atan2(l1 + l2 * joint_2.cos());
            (half_turn(joint_1), joint_2)
        };
        Ok([elbow(bent), elbow(-bent)])
    }

    /// Which joint is farthest outside its limits, and by how much, rad; negative inside.
    fn beyond(&self, joints: &Vector3<f64>) -> (usize, f64) {
        let outside = (self.low - joints).sup(&(joints - self.high));
        outside.argmax()
    }

    fn refuse(&self, tip: &Vector3<f64>, solutions: &[Option<Vector3<f64>>; 4]) -> OutOfReach {
        // Where only the way over the base is left and closed, what closes the direct one tells more.
        if let Err(refusal) = self.elbows(tip.x.hypot(tip.z), tip.y) {
            return refusal;
        }
        let beyond = |joints: &Vector3<f64>| self.beyond(joints).1;
        let least = |one: Vector3<f64>, other: Vector3<f64>| if beyond(&other) < beyond(&one) { other } else { one };
        // There is a solution: without one the refusal has been another.
        let joints = solutions.iter().flatten().copied().reduce(least).unwrap_or_default();
        let joint = self.beyond(&joints).0;
        OutOfReach::BeyondLimits { joint, value: joints[joint], low: self.low[joint], high: self.high[joint] }
    }
}

/// The same angle in -pi to pi.
fn half_turn(angle: f64) -> f64 {
    angle - 2.0 * PI * (angle / (2.0 * PI)).round()
}
