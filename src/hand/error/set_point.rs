//! The errors of a set point.

use crate::model::FingerNumber;
use crate::model::{ContactError, OutOfReach};
use thiserror::Error;

/// The reason why a finger refuses a set point, stiffness, contact or damping.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SetPointError {
    /// An argument contains NaN or infinity.
    #[error("{what} of finger {finger} contains {value}: every entry must be a finite number")]
    NotFinite {
        /// The name of the argument.
        what: &'static str,
        /// The finger.
        finger: FingerNumber,
        /// The first entry that is not finite.
        value: f64,
    },
    /// A joint angle is outside its limits.
    #[error(
        "joint {joint} would be at {value:.4} rad, outside the limits of finger {finger}, {low:.4} to {high:.4} rad: \
         send an angle within the limits, widen them in `finger.joints`, or set `hand.out_of_range = \"clamp\"`"
    )]
    BeyondJointLimit {
        /// The finger.
        finger: FingerNumber,
        /// Number of the joint, 0 to 2.
        joint: usize,
        /// The requested angle, rad.
        value: f64,
        /// Lower limit, rad.
        low: f64,
        /// Upper limit, rad.
        high: f64,
    },
    /// The set point that was sent last is beyond the joint limits that an adjustment would set.
    #[error(
        "the set point that was sent last to finger {finger} has joint {joint} at {value:.4} rad, outside the new \
         limits, {low:.4} to {high:.4} rad: send a set point within the new limits first, set wider limits, or set \
         `hand.out_of_range = \"clamp\"`, which moves the joint to the limit"
    )]
    SentBeyondJointLimit {
        /// The finger.
        finger: FingerNumber,
        /// Number of the joint, 0 to 2.
        joint: usize,
        /// The angle in the set point, rad.
        value: f64,
        /// The new lower limit, rad.
        low: f64,
        /// The new upper limit, rad.
        high: f64,
    },
    /// The path that the finger follows goes beyond the joint limits that an adjustment would set.
    #[error(
        "the path that finger {finger} follows takes joint {joint} to {value:.4} rad, outside the new limits, {low:.4} \
         to {high:.4} rad: repeat the adjustment when the path has ended, send another path or position first, or set \
         `hand.out_of_range = \"clamp\"`, which ends the path"
    )]
    PathBeyondJointLimit {
        /// The finger.
        finger: FingerNumber,
        /// Number of the joint, 0 to 2.
        joint: usize,
        /// The angle that is farthest beyond the limit, rad.
        value: f64,
        /// The new lower limit, rad.
        low: f64,
        /// The new upper limit, rad.
        high: f64,
    },
    /// Kx is stiffer than the bound.
    #[error(
        "the largest eigenvalue of Kx of finger {finger} is {largest:.3} N/cm, above the bound of {bound:.3} N/cm: \
         send a softer Kx, or set `hand.out_of_range = \"clamp\"`"
    )]
    TooStiff {
        /// The finger.
        finger: FingerNumber,
        /// Largest eigenvalue, N/cm.
        largest: f64,
        /// The bound, N/cm.
        bound: f64,
    },
    /// A contact is stiffer than the bound.
    #[error(
        "the largest eigenvalue of the contact stiffness of finger {finger} is {largest:.3} N/cm (its rotational part \
         is converted with the length of the last link), above the bound of {bound:.3} N/cm: send a softer contact, or \
         set `hand.out_of_range = \"clamp\"`"
    )]
    TooStiffContact {
        /// The finger.
        finger: FingerNumber,
        /// Largest eigenvalue, N/cm.
        largest: f64,
        /// The bound, N/cm.
        bound: f64,
    },
    /// Kx is not symmetric.
    #[error(
        "Kx of finger {finger} is not symmetric: Kx[{row}][{column}] and Kx[{column}][{row}] differ by \
         {difference:.3e} N/cm, more than a thousandth of its largest entry. Send a symmetric Kx"
    )]
    NotSymmetric {
        /// The finger.
        finger: FingerNumber,
        /// Row of the first entry `Kx[row][column]` that differs from `Kx[column][row]` by more than a thousandth of
        /// the largest entry.
        row: usize,
        /// Column of this entry.
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
        finger: FingerNumber,
        /// Smallest eigenvalue, N/cm.
        smallest: f64,
    },
    /// A joint stiffness is not that of a spring.
    #[error("the joint stiffness of finger {finger} is invalid: {source}")]
    JointStiffness {
        /// The finger.
        finger: FingerNumber,
        /// What is wrong.
        source: ContactError,
    },
    /// A joint stiffness is above the bound.
    #[error(
        "the largest eigenvalue of the joint stiffness of finger {finger} is {largest:.3} N cm/rad, above the bound of \
         {bound:.3} N cm/rad: send a softer joint stiffness, or set `hand.out_of_range = \"clamp\"`"
    )]
    TooStiffJoints {
        /// The finger.
        finger: FingerNumber,
        /// Largest eigenvalue, N cm/rad.
        largest: f64,
        /// The bound, N cm/rad.
        bound: f64,
    },
    /// The tendons cannot make a joint torque.
    #[error(
        "the tendons of finger {finger} can make only {part:.3} of the joint torque: send less torque, or set \
         `hand.out_of_range = \"clamp\"`. If the other joints have no torque, joint 0 may have {:.2} to {:.2} N cm, \
         joint 1 {:.2} to {:.2} N cm, or joint 2 {:.2} to {:.2} N cm",
        least[0], most[0], least[1], most[1], least[2], most[2]
    )]
    TooMuchTorque {
        /// The finger.
        finger: FingerNumber,
        /// The part of the torque that the tendons can make.
        part: f64,
        /// The smallest torque of each joint while the others have none, N cm.
        least: [f64; 3],
        /// The largest torque of each joint while the others have none, N cm.
        most: [f64; 3],
    },
    /// The finger cannot reach the fingertip position.
    #[error("the tip of finger {finger} cannot be at {:.3}, {:.3}, {:.3} cm: {source}", tip[0], tip[1], tip[2])]
    OutOfReach {
        /// The finger.
        finger: FingerNumber,
        /// The requested position, cm.
        tip: [f64; 3],
        /// The reason.
        source: OutOfReach,
    },
    /// The stiffness or normal of a contact is invalid.
    #[error("the contact of finger {finger} is invalid: {source}")]
    Contact {
        /// The finger.
        finger: FingerNumber,
        /// What is wrong.
        source: ContactError,
    },
    /// The contact type does not exist.
    #[error(
        "there is no contact with {0} dimensions: a frictionless point has 1, a hard finger with friction 3, and a \
         soft finger 4"
    )]
    NoSuchContact(i32),
    /// The number of commands of a group is not possible.
    #[error("a group has 0 to 3 commands, and not {0}: send at most one command for each finger")]
    GroupSize(i32),
    /// The condition to wait for does not exist.
    #[error("there is no condition {0} to wait for: pass the constant for \"arrived\" or for \"settled\"")]
    NoSuchCondition(i32),
    /// A time limit is negative or NaN.
    #[error("the time limit of {0} s is negative or not a number: pass zero or a positive time")]
    NoSuchLimit(f64),
    /// A component of gravity is NaN, infinite or beyond 100 m/s^2.
    #[error("gravity[{component}] is {value:?} m/s^2: pass a number from -100 to 100")]
    Gravity {
        /// 0, 1 and 2 for x, y and z.
        component: usize,
        /// The component, m/s^2.
        value: f64,
    },
    /// A command of a group has joint angles and a position of the tip.
    #[error("the command for finger {0} has joint angles and a position of the tip: leave one of them out")]
    TwoPoses(i32),
    /// A group has two commands for a finger.
    #[error("the group has two commands for finger {0}: put them into one")]
    TwiceInGroup(FingerNumber),
    /// Many groups have not taken effect yet.
    #[error(
        "finger {0} has 16 groups that have not taken effect yet: send at most one group in each period of the servo, \
         and check that the servo runs"
    )]
    GroupsWaiting(FingerNumber),
    /// The damping ratio is outside its range.
    #[error(
        "the damping ratio {ratio} of finger {finger} is outside {least:.2} to {most:.2}, the stable range at a \
         stiffness of {stiffness:.4} N/cm: send a ratio within the range (a softer Kx has a wider range), or set \
         `hand.out_of_range = \"clamp\"`"
    )]
    Damping {
        /// The finger.
        finger: FingerNumber,
        /// The requested damping, as a ratio to the damping that the controller chooses.
        ratio: f64,
        /// Largest eigenvalue of the stiffness of the refused set point, N/cm. Rotational and joint stiffnesses are
        /// converted to N/cm.
        stiffness: f64,
        /// The smallest permitted ratio.
        least: f64,
        /// The largest permitted ratio.
        most: f64,
    },
}

impl SetPointError {
    /// Returns whether a stiffness was refused because it is not that of a spring, or because the normal of its contact
    /// is zero.
    pub(crate) fn is_no_spring(&self) -> bool {
        self.errno() == libc::EDOM
    }

    /// Returns the errno that describes the error best.
    #[must_use]
    pub fn errno(&self) -> i32 {
        match self {
            Self::NotFinite { .. } | Self::NoSuchContact(_) | Self::TwiceInGroup(_) => libc::EINVAL,
            Self::GroupSize(_) | Self::TwoPoses(_) | Self::NoSuchCondition(_) | Self::NoSuchLimit(_) => libc::EINVAL,
            Self::Gravity { .. } => libc::EINVAL,
            Self::GroupsWaiting(_) => libc::EBUSY,
            Self::Contact { source: ContactError::NotFinite(_), .. } => libc::EINVAL,
            Self::BeyondJointLimit { .. } | Self::TooMuchTorque { .. } => libc::ERANGE,
            Self::TooStiff { .. } | Self::TooStiffContact { .. } | Self::TooStiffJoints { .. } => libc::ERANGE,
            Self::OutOfReach { .. } | Self::Damping { .. } => libc::ERANGE,
            Self::SentBeyondJointLimit { .. } | Self::PathBeyondJointLimit { .. } => libc::ERANGE,
            Self::NotSymmetric { .. } | Self::Negative { .. } | Self::Contact { .. } => libc::EDOM,
            Self::JointStiffness { .. } => libc::EDOM,
        }
    }
}
