//! The inverse kinematics (the block A^-1), which the report omits: joint angles for a fingertip position, in closed
//! form.

use crate::model::Links;
use nalgebra::Vector3;
use std::f64::consts::PI;
use thiserror::Error;

/// Distance beyond a joint limit, rad, at which a solution still counts as being at the limit. It covers the rounding
/// of a tip position stored as `float`, and moves the tip by less than a hundredth of a millimetre.
const LIMIT_ROUNDING: f64 = 1e-5;

/// Distance of the tip from the axis of joint 0, cm, below which the angle of joint 0 is undetermined. The present
/// angle is then kept.
const ON_THE_AXIS: f64 = 1e-9;

/// Fraction of l1 + l2 by which rounding may put a tip outside the reach of the finger.
const REACH_ROUNDING: f64 = 1e-9;

/// A^-1 of Figure 9 for one finger within its joint limits.
#[derive(Clone, Debug)]
pub struct InverseKinematics {
    links: Links,
    low: Vector3<f64>,
    high: Vector3<f64>,
}

/// The reason why the finger cannot reach a tip position.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum OutOfReach {
    /// The point is farther away than the outstretched finger reaches.
    #[error(
        "this point is {distance:.3} cm from the axis of joint 1, and the outstretched finger reaches {reach:.3} cm. \
         Send a point that is nearer"
    )]
    TooFar {
        /// Distance from the axis of joint 1 to the tip, cm.
        distance: f64,
        /// l1 + l2, cm.
        reach: f64,
    },
    /// The point is nearer than the tip of the folded finger can come.
    #[error(
        "this point is {distance:.3} cm from the axis of joint 1, and the folded finger comes no nearer than \
         {least:.3} cm. Send a point that is farther away"
    )]
    TooNear {
        /// Distance from the axis of joint 1 to the tip, cm.
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
        /// Number of the joint, 0 to 2, that is farthest outside its limits in the solution closest to the limits.
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
    /// Constructs A^-1. `limits` are the lower and upper joint limits, rad, within -pi to pi.
    pub fn new(links: Links, limits: (Vector3<f64>, Vector3<f64>)) -> Self {
        Self { links, low: limits.0, high: limits.1 }
    }

    /// Returns the joint angles within the limits, rad, with the tip at `tip` (cm, in the finger's frame). Of several
    /// solutions it returns the one whose largest joint motion from `present` is smallest, so that the finger does not
    /// change to another solution on its way.
    ///
    /// # Errors
    /// Returns an error if there is no solution, or if no solution is within the limits.
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

    /// Returns every solution within -pi to pi, rad, regardless of the joint limits. Joint 0 points toward the tip or
    /// away from it. If it points away, the finger bends over its own base. For each of the two angles of joint 0 there
    /// are two solutions for joints 1 and 2. `on_axis` is the angle of joint 0 for a tip on its axis.
    ///
    /// # Errors
    /// Returns an error if there is no solution.
    pub fn solutions(&self, tip: &Vector3<f64>, on_axis: f64) -> Result<[Option<Vector3<f64>>; 4], OutOfReach> {
        let across = tip.x.hypot(tip.z);
        let toward = if across < ON_THE_AXIS { on_axis } else { tip.x.atan2(tip.z) };
        let away = wrapped(toward + PI);
        let [one, other] = match (self.elbows(across, tip.y), self.elbows(-across, tip.y)) {
            // In the direct solution, joint 0 points toward the tip. A finger that bends over its base spans a larger
            // distance, so it may reach a tip that is too near for the direct solution.
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

    /// Returns the two solutions for joints 1 and 2 in the plane of joint 0, by the law of cosines. `across` is the
    /// distance of the tip from the axis of joint 0, cm, negative if joint 0 points away from the tip. `y` is the tip's
    /// y coordinate, cm.
    fn elbows(&self, across: f64, y: f64) -> Result<[(f64, f64); 2], OutOfReach> {
        let [l0, l1, l2] = self.links.0;
        let (along, down) = (across - l0, -y);
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
            (wrapped(joint_1), joint_2)
        };
        Ok([elbow(bent), elbow(-bent)])
    }

    /// Returns the joint that is farthest outside its limits, and its distance from the limit, rad. The distance is
    /// negative if the joint is inside its limits.
    fn beyond(&self, joints: &Vector3<f64>) -> (usize, f64) {
        let outside = (self.low - joints).sup(&(joints - self.high));
        outside.argmax()
    }

    fn refuse(&self, tip: &Vector3<f64>, solutions: &[Option<Vector3<f64>>; 4]) -> OutOfReach {
        // If the direct solution does not exist and the solution over the base is outside the limits, the reason why
        // the direct one does not exist is more useful.
        if let Err(refusal) = self.elbows(tip.x.hypot(tip.z), tip.y) {
            return refusal;
        }
        let beyond = |joints: &Vector3<f64>| self.beyond(joints).1;
        let least = |one: Vector3<f64>, other: Vector3<f64>| if beyond(&other) < beyond(&one) { other } else { one };
        // There is a solution, because otherwise `solutions` has already returned an error.
        let joints = solutions.iter().flatten().copied().reduce(least).unwrap_or_default();
        let joint = self.beyond(&joints).0;
        OutOfReach::BeyondLimits { joint, value: joints[joint], low: self.low[joint], high: self.high[joint] }
    }
}

/// Wraps an angle, rad, to the range -pi to pi.
fn wrapped(angle: f64) -> f64 {
    angle - 2.0 * PI * (angle / (2.0 * PI)).round()
}
