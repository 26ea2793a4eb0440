//! The extent of a path. It is compared with limits that change while a finger follows the path.

use crate::control::motion::PathTable;
use nalgebra::{Matrix6, Vector3};

/// The extremes of a path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PathExtent {
    /// Lower bounds of the joint angles, rad.
    pub lowest: Vector3<f64>,
    /// Upper bounds of the joint angles, rad.
    pub highest: Vector3<f64>,
    /// The stiffest spring of the path, including the spring with which the path begins; none if the path does not
    /// change the stiffness. It has the units and axes of
    /// [`SetPoint::stiffness`](crate::control::SetPoint::stiffness).
    pub stiffest: Option<Matrix6<f64>>,
}

impl PathTable<'_> {
    /// Returns lower and upper bounds of the joint angles on the whole path, rad.
    pub fn bounds(&self) -> (Vector3<f64>, Vector3<f64>) {
        let (mut lowest, mut highest) = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
        for piece in self.pieces {
            let (least, most) = piece.bounds(0);
            (lowest, highest) = (lowest.inf(&least), highest.sup(&most));
        }
        (lowest, highest)
    }
}
