//! Why a set point is refused.

use crate::model::{ContactError, OutOfReach};
use thiserror::Error;

/// A set point, stiffness, contact or damping that a finger cannot take.
#[derive(Debug, Error)]
pub enum SetPointError {
    /// NaN or infinity in an argument.
    #[error("{what} of finger {finger} contains {value}: every entry must be a finite number")]
    NotFinite {
        /// The argument.
        what: &'static str,
        /// 1 to 3.
        finger: i32,
        /// The first such entry.
        value: f64,
    },
    /// Pos outside the joint limits.
    #[error(
        "Pos[{joint}] = {value:.4} rad is outside the limits of finger {finger}, {low:.4} to {high:.4} rad: send an \
         angle inside them, change `finger.joints`, or set `hand.out_of_range = \"clamp\"`"
    )]
    BeyondJointLimit {
        /// 1 to 3.
        finger: i32,
        /// 0 to 2.
        joint: usize,
        /// What was asked, rad.
        value: f64,
        /// Lower limit, rad.
        low: f64,
        /// Upper limit, rad.
        high: f64,
    },
    /// Kx stiffer than the bound.
    #[error(
        "the largest eigenvalue of Kx of finger {finger} is {largest:.3} N/cm, above the bound of {bound:.3} N/cm: \
         send a softer Kx, or set `hand.out_of_range = \"clamp\"`"
    )]
    TooStiff {
        /// 1 to 3.
        finger: i32,
        /// Largest eigenvalue, N/cm.
        largest: f64,
        /// The bound, N/cm.
        bound: f64,
    },
    /// Kx not symmetric.
    #[error(
        "Kx of finger {finger} is not symmetric: Kx[{row}][{column}] and Kx[{column}][{row}] differ by \
         {difference:.3e} N/cm, more than a thousandth of its largest entry. Send a symmetric Kx, as every spring has"
    )]
    NotSymmetric {
        /// 1 to 3.
        finger: i32,
        /// Row of the worst pair.
        row: usize,
        /// Column of the worst pair.
        column: usize,
        /// Their difference, N/cm.
        difference: f64,
    },
    /// Kx with a negative eigenvalue.
    #[error(
        "Kx of finger {finger} has the negative eigenvalue {smallest:.3e} N/cm, so the finger would push itself away \
         from its set point: send a Kx whose eigenvalues are zero or positive"
    )]
    Negative {
        /// 1 to 3.
        finger: i32,
        /// Smallest eigenvalue, N/cm.
        smallest: f64,
    },
    /// A fingertip position that the finger does not reach.
    #[error("the tip of finger {finger} cannot be at {:.3}, {:.3}, {:.3} cm: {source}", tip[0], tip[1], tip[2])]
    OutOfReach {
        /// 1 to 3.
        finger: i32,
        /// What was asked, cm.
        tip: [f64; 3],
        /// Why not.
        source: OutOfReach,
    },
    /// The stiffness of a contact that is none.
    #[error("the contact of finger {finger}: {source}")]
    Contact {
        /// 1 to 3.
        finger: i32,
        /// What is wrong with it.
        source: ContactError,
    },
    /// A contact of a type that is not known.
    #[error(
        "there is no contact of {0} dimensions: 1 is a frictionless point, 3 a hard finger with friction, 4 a soft \
         finger"
    )]
    NoSuchContact(i32),
    /// A damping ratio outside its range.
    #[error(
        "the damping {ratio} of finger {finger} is outside {least:.2} to {most:.2}, the range in which a spring of \
         {stiffness:.4} N/cm comes to rest: send a ratio inside the range or a softer Kx first, or set \
         `hand.out_of_range = \"clamp\"`"
    )]
    Damping {
        /// 1 to 3.
        finger: i32,
        /// Relative to the damping that the controller chooses.
        ratio: f64,
        /// Largest eigenvalue of the stiffness that goes with it, N/cm.
        stiffness: f64,
        /// Least.
        least: f64,
        /// Most.
        most: f64,
    },
}

impl SetPointError {
    /// The nearest errno.
    pub fn errno(&self) -> i32 {
        match self {
            Self::NotFinite { .. } | Self::NoSuchContact(_) => libc::EINVAL,
            Self::Contact { source: ContactError::NotFinite(_), .. } => libc::EINVAL,
            Self::BeyondJointLimit { .. } | Self::TooStiff { .. } => libc::ERANGE,
            Self::OutOfReach { .. } | Self::Damping { .. } => libc::ERANGE,
            Self::NotSymmetric { .. } | Self::Negative { .. } | Self::Contact { .. } => libc::EDOM,
        }
    }
}
