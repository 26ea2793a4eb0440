//! The reference of a finger: the joint angles that its moving set point has reached, and their derivatives.

use crate::control::Motion;
use nalgebra::Vector3;

/// The reference that the controller follows. If the finger does not follow set points, the reference is the measured
/// pose.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Reference {
    /// Number of the period: the cycles since open in which the controller ran, plus the periods that it skipped.
    pub period: u64,
    /// Joint angles, rad.
    pub joints: Vector3<f64>,
    /// Derivatives of the joint angles.
    pub motion: Motion,
}
