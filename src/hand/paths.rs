//! Timed paths: poses with times, which a finger passes in smooth motion.

mod limits;
mod plan;
mod tips;

pub use plan::{Plan, plan_path};

use crate::hand::{Hand, HandError, Pose};
use std::time::Duration;

/// A pose of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPose {
    /// Time since the beginning of the path, s.
    pub time: f64,
    /// Where the finger is at this time. All poses of a path are of one kind. Between the poses the joint angles, or
    /// the tip, follow a spline. If the path begins at rest and its only pose is a position of the tip, the
    /// tip moves along a straight line.
    pub pose: Pose,
    /// Kx in the finger's frame, N/cm: `rows[row][column]`. Kx reaches this value at the time of the pose. It changes
    /// linearly from the previous pose with a Kx, or from the beginning of the path if there is none. With `None`, the
    /// pose does not affect Kx.
    pub stiffness: Option<[[f64; 3]; 3]>,
}

impl Hand {
    /// Sends a path to finger 1, 2 or 3. The path begins at once at the anchor of the tip's spring, continues the
    /// motion of the anchor, passes every pose at its time, and rests at the last one. Joint angles, rates,
    /// accelerations and jerk are continuous, with one exception: if a path that continues the motion would be refused,
    /// the finger first brakes for 0.15 s. The braking begins with the present rates, but without acceleration and
    /// jerk. State feedback smooths this step in acceleration and jerk. State feedback also feeds rates, accelerations
    /// and jerk forward, so the finger follows without the lag with which it follows a single set point.
    ///
    /// The whole path is checked against the joint limits and the limits of `[finger.motion]` before anything moves. If
    /// commands are clamped, joint angles and Kx are clamped, and a path that is too fast is made slower as a whole. A
    /// path that is out of reach, or that is outside the joint limits between two poses, is refused nevertheless.
    ///
    /// A later path, or a later desired pose, replaces the path without a jump. A Kx that is sent while the path runs
    /// takes effect at once, and the path no longer changes Kx.
    ///
    /// `valid` is how long the path stays valid after its end. With `None`, this is the configured time.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, if the finger is faulted or is not a spring, if the path is refused
    /// ([`PathError`](super::PathError)), or if a Kx is too stiff for the damping ratio. Then the call changes nothing.
    pub fn send_path(&self, finger: i32, poses: &[PathPose], valid: Option<Duration>) -> Result<(), HandError> {
        self.send_together(&[], &[(finger, poses, valid)])
    }
}
