//! The checks of a planner's commands against the newest Status. A command that fails a check is not sent.

use crate::command::{FingerCommand, Pose};
use crate::spring::{NotASpring, largest_eigenvalue};
use sun2xp_remote_protocol::{FINGERS, Finger, FingerStatus, MOST_POSES, PathPose};
use thiserror::Error;

/// Smallest difference between the times of two consecutive poses, s.
const LEAST_STEP: f64 = 1e-3;

/// Rounding error of the difference of two times, s. Poses that are exactly [`LEAST_STEP`] apart are accepted, as the
/// library on the server's machine accepts them.
const TIME_ROUNDING: f64 = 1e-9;

/// Longest path, s.
const LONGEST: f64 = 3600.0;

/// Why a command cannot be sent.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum AdmissionError {
    /// An argument contains NaN or infinity.
    #[error("{what} of finger {finger} contains {value}: every entry must be a finite number")]
    NotFinite {
        /// The name of the argument.
        what: &'static str,
        /// The finger.
        finger: Finger,
        /// The first entry that is not finite.
        value: f64,
    },
    /// A joint angle is outside its limits.
    #[error(
        "joint {joint} would be at {value:.4} rad, outside the limits of finger {finger}, {low:.4} to {high:.4} rad: \
         send an angle within the limits, or widen them in `finger.joints` of the server's configuration"
    )]
    BeyondJointLimit {
        /// The finger.
        finger: Finger,
        /// Number of the joint, 0 to 2.
        joint: usize,
        /// The requested angle, rad.
        value: f64,
        /// Lower limit, rad.
        low: f64,
        /// Upper limit, rad.
        high: f64,
    },
    /// Kx is stiffer than the bound.
    #[error(
        "the largest eigenvalue of Kx of finger {finger} is {largest:.3} N/cm, above the bound of {bound:.3} N/cm: \
         send a softer Kx"
    )]
    TooStiff {
        /// The finger.
        finger: Finger,
        /// Largest eigenvalue, N/cm.
        largest: f64,
        /// The bound, N/cm.
        bound: f64,
    },
    /// Kx is not symmetric: `Kx[row][column]` and `Kx[column][row]` differ.
    #[error(
        "Kx of finger {finger} is not symmetric: Kx[{row}][{column}] and Kx[{column}][{row}] differ by \
         {difference:.3e} N/cm, more than a thousandth of its largest entry. Send a symmetric Kx"
    )]
    NotSymmetric {
        /// The finger.
        finger: Finger,
        /// Row of the first such pair.
        row: usize,
        /// Column of the first such pair.
        column: usize,
        /// Difference of the two entries, N/cm.
        difference: f64,
    },
    /// Kx has a negative eigenvalue.
    #[error(
        "Kx of finger {finger} has the negative eigenvalue {smallest:.3e} N/cm, so the finger would push itself away \
         from its set point: send a Kx whose eigenvalues are zero or positive"
    )]
    Negative {
        /// The finger.
        finger: Finger,
        /// Smallest eigenvalue, N/cm.
        smallest: f64,
    },
    /// A damping ratio is negative.
    #[error("the damping ratio {ratio} of finger {finger} is negative: send a ratio near 1, which is the normal ratio")]
    Damping {
        /// The finger.
        finger: Finger,
        /// The requested ratio.
        ratio: f64,
    },
    /// A group has two commands for a finger.
    #[error("the group has two commands for finger {0}: put them into one")]
    TwiceInGroup(Finger),
    /// The path has no pose, or too many.
    #[error("the path has {count} poses: send 1 to {MOST_POSES} poses, and further ones as another path")]
    Count {
        /// Number of poses.
        count: usize,
    },
    /// A time is NaN, above the longest permitted time, or less than 1 ms later than the time before it, which is 0 for
    /// the first pose.
    #[error(
        "the time of pose {pose} of the path of finger {finger} is {time} s after the beginning of the path: send a \
         time of at most {LONGEST} s that is at least {LEAST_STEP} s later than {} ({before} s)",
        if *pose == 0 { "the beginning of the path" } else { "the pose before it" }
    )]
    Time {
        /// The finger.
        finger: Finger,
        /// The pose, from 0.
        pose: usize,
        /// Its time, s.
        time: f64,
        /// The time of the pose before it, or 0 for the first pose, s.
        before: f64,
    },
}

/// Checks a command.
pub fn admit(status: &FingerStatus, finger: Finger, command: &FingerCommand) -> Result<(), AdmissionError> {
    match &command.pose {
        Some(Pose::Joints(joints)) => admit_joints(status, finger, joints)?,
        Some(Pose::Tip(tip)) => finite("Tip", finger, tip)?,
        None => {}
    }
    if let Some(rows) = &command.stiffness {
        admit_stiffness(status, finger, rows)?;
    }
    let Some(ratio) = command.damping else { return Ok(()) };
    finite("Damping", finger, &[ratio])?;
    if ratio >= 0.0 { Ok(()) } else { Err(AdmissionError::Damping { finger, ratio }) }
}

fn admit_joints(status: &FingerStatus, finger: Finger, joints: &[f64; 3]) -> Result<(), AdmissionError> {
    finite("Pos", finger, joints)?;
    for (joint, &value) in joints.iter().enumerate() {
        let (low, high) = (status.low[joint], status.high[joint]);
        // An angle at the limit that is sent as `float` may be rounded beyond the limit. It must be accepted.
        let rounding = f64::from(f32::EPSILON) * low.abs().max(high.abs());
        if value < low - rounding || value > high + rounding {
            return Err(AdmissionError::BeyondJointLimit { finger, joint, value, low, high });
        }
    }
    Ok(())
}

fn admit_stiffness(status: &FingerStatus, finger: Finger, rows: &[[f64; 3]; 3]) -> Result<(), AdmissionError> {
    finite("Kx", finger, rows.as_flattened())?;
    let largest = largest_eigenvalue(rows).map_err(|error| match error {
        NotASpring::NotSymmetric { row, column, difference } => {
            AdmissionError::NotSymmetric { finger, row, column, difference }
        }
        NotASpring::Negative(smallest) => AdmissionError::Negative { finger, smallest },
    })?;
    let bound = status.stiffness_bound;
    // A stiffness at the bound that is sent as `float` may be rounded beyond the bound. It must be accepted.
    if largest <= bound * (1.0 + 8.0 * f64::from(f32::EPSILON)) {
        return Ok(());
    }
    Err(AdmissionError::TooStiff { finger, largest, bound })
}

/// Checks a path.
pub fn admit_path(status: &FingerStatus, finger: Finger, poses: &[PathPose]) -> Result<(), AdmissionError> {
    if !(1..=MOST_POSES).contains(&poses.len()) {
        return Err(AdmissionError::Count { count: poses.len() });
    }
    let mut before = 0.0;
    for (pose, &PathPose { time, ref joints }) in poses.iter().enumerate() {
        // This form of the comparison rejects NaN.
        if !(time >= before + (LEAST_STEP - TIME_ROUNDING) && time <= LONGEST) {
            return Err(AdmissionError::Time { finger, pose, time, before });
        }
        before = time;
        admit_joints(status, finger, joints)?;
    }
    Ok(())
}

/// Returns the commands by finger. Refuses two commands for one finger.
pub fn by_finger<'a>(
    commands: &[(Finger, &'a FingerCommand)],
) -> Result<[Option<&'a FingerCommand>; FINGERS], AdmissionError> {
    let mut sorted = [None; FINGERS];
    for &(finger, command) in commands {
        if sorted[finger.index()].replace(command).is_some() {
            return Err(AdmissionError::TwiceInGroup(finger));
        }
    }
    Ok(sorted)
}

fn finite(what: &'static str, finger: Finger, values: &[f64]) -> Result<(), AdmissionError> {
    match values.iter().find(|value| !value.is_finite()) {
        None => Ok(()),
        Some(&value) => Err(AdmissionError::NotFinite { what, finger, value }),
    }
}

impl AdmissionError {
    /// The finger that the error names; none if it names no finger.
    pub(crate) fn finger(&self) -> Option<Finger> {
        match self {
            Self::NotFinite { finger, .. }
            | Self::BeyondJointLimit { finger, .. }
            | Self::TooStiff { finger, .. }
            | Self::NotSymmetric { finger, .. }
            | Self::Negative { finger, .. }
            | Self::Damping { finger, .. }
            | Self::TwiceInGroup(finger)
            | Self::Time { finger, .. } => Some(*finger),
            Self::Count { .. } => None,
        }
    }
}
