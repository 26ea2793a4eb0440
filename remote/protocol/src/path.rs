//! The poses of a path.

use crate::error::{FieldError, Reason, finite, within};

/// The largest number of poses of a path.
pub const MOST_POSES: usize = 32;

/// A pose of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPose {
    /// Time after the server has applied the path, s. It is above 0.
    pub time: f64,
    /// Angles of joints 0, 1 and 2 at this time, rad.
    pub joints: [f64; 3],
}

impl PathPose {
    /// Bytes of a pose.
    pub(crate) const LENGTH: usize = 32;
}

/// Checks the number of poses, and that their times are above 0 and rise.
pub(crate) fn check(poses: &[PathPose]) -> Result<(), FieldError> {
    within("number of poses", poses.len() as u64, 1, MOST_POSES as u64)?;
    let mut before = 0.0;
    for (index, pose) in poses.iter().enumerate() {
        finite("time of a pose", &[pose.time])?;
        finite("joint angles of a pose", &pose.joints)?;
        if pose.time <= before {
            return Err(FieldError::new("time of a pose", Reason::PoseTime { pose: index, time: pose.time }));
        }
        before = pose.time;
    }
    Ok(())
}
