//! The errors of a path.

use crate::hand::SetPointError;
use crate::model::FingerNumber;
use thiserror::Error;

/// The reason why a finger refuses a path. Poses are numbered from 0.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PathError {
    /// The path has no pose, or too many.
    #[error("the path has {count} poses: send 1 to {most} poses, and further ones as another path")]
    Count {
        /// Number of poses. A C program can pass a negative number.
        count: i64,
        /// The largest number of poses.
        most: usize,
    },
    /// A set point cannot be valid for the given time.
    #[error("a set point cannot be valid for {0} s: send 0 for the configured time, or up to 3600 s")]
    Valid(f64),
    /// A time is NaN, above the longest permitted time, or less than 1 ms later than the time before it. For the first
    /// pose, the time before it is 0.
    #[error(
        "the time of pose {pose} of the path of finger {finger} is {time} s after the beginning of the path: send a \
         time of at most {most} s that is at least {least} s later than {} ({before} s)",
        if *pose == 0 { "the beginning of the path" } else { "the pose before it" }
    )]
    Time {
        /// The finger.
        finger: FingerNumber,
        /// The pose.
        pose: usize,
        /// Its time, s.
        time: f64,
        /// The time of the pose before it, or 0 for the first pose, s.
        before: f64,
        /// Smallest distance of two times, s.
        least: f64,
        /// Largest time, s.
        most: f64,
    },
    /// The path mixes joint angles and tip positions.
    #[error(
        "pose {pose} of the path of finger {finger} is of another kind than pose 0: send joint angles or tip positions \
         in all poses"
    )]
    Mixed {
        /// The finger.
        finger: FingerNumber,
        /// The first pose of another kind.
        pose: usize,
    },
    /// The finger cannot take a pose, or a place on the way to it.
    #[error("{} pose {pose} of the path: {source}", if *on_the_way { "on the way to" } else { "in" })]
    Pose {
        /// The pose.
        pose: usize,
        /// Whether the place is between this pose and the one before.
        on_the_way: bool,
        /// The reason.
        source: SetPointError,
    },
    /// The path leaves the joint limits between two poses.
    #[error(
        "on the way to pose {pose}, joint {joint} of finger {finger} would go to {value:.4} rad, outside the permitted \
         range of {low:.4} to {high:.4} rad: add poses in this part of the path, or allow more time for the parts \
         directly before and after this part"
    )]
    BeyondJointLimit {
        /// The finger.
        finger: FingerNumber,
        /// The pose.
        pose: usize,
        /// Number of the joint, 0 to 2.
        joint: usize,
        /// The extreme angle of the joint in this part of the path, rad. It is below `low` or above `high`.
        value: f64,
        /// The lower joint limit, or the angle at which the path begins if this angle is lower, rad.
        low: f64,
        /// The upper joint limit, or the angle at which the path begins if this angle is higher, rad.
        high: f64,
    },
    /// The path is too fast.
    #[error(
        "on the way to pose {pose}, the {quantity} of joint {joint} of finger {finger} would reach {value:.3} {unit}, \
         above `finger.motion.{quantity}` = {limit}: multiply all times by {factor:.2}, give \
         this part of the path more time, or set `hand.out_of_range = \"clamp\"`, which multiplies the times"
    )]
    TooFast {
        /// The finger.
        finger: FingerNumber,
        /// The pose.
        pose: usize,
        /// Number of the joint, 0 to 2.
        joint: usize,
        /// `speed`, `acceleration` or `jerk`.
        quantity: &'static str,
        /// The unit of the quantity.
        unit: &'static str,
        /// The largest value on the path.
        value: f64,
        /// The configured limit.
        limit: f64,
        /// The factor by which the whole path must be slower, rounded up to a multiple of 0.01.
        factor: f64,
    },
    /// A tip path cannot be followed exactly.
    #[error(
        "on the way to pose {pose}, the tip of finger {finger} would leave the path by {deviation:.3} cm, because the \
         library divides a path into at most {pieces} pieces: send the path in two parts"
    )]
    Coarse {
        /// The finger.
        finger: FingerNumber,
        /// The pose.
        pose: usize,
        /// The largest distance from the path, cm.
        deviation: f64,
        /// The largest number of pieces of a path.
        pieces: usize,
    },
    /// While the path was computed, the finger was recovered or calibrated, its set point expired, a reflex reacted, or
    /// the inhibition ended. The inhibition is the time after a reaction in which the finger does not follow its
    /// planner.
    #[error(
        "the path of finger {0} was not sent, because while it was computed, the finger was recovered or calibrated, \
         its set point expired, a reflex reacted, or the inhibition after a reflex ended: send the path again"
    )]
    Moved(FingerNumber),
}

impl PathError {
    /// Returns the errno that describes the error best.
    #[must_use]
    pub fn errno(&self) -> i32 {
        match self {
            Self::Count { .. } | Self::Valid(_) | Self::Time { .. } | Self::Mixed { .. } => libc::EINVAL,
            Self::Pose { source, .. } => source.errno(),
            Self::BeyondJointLimit { .. } | Self::TooFast { .. } | Self::Coarse { .. } => libc::ERANGE,
            Self::Moved(_) => libc::EAGAIN,
        }
    }
}
