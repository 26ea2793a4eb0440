//! The result of the contact estimate.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// An estimate of what the surroundings exert on a finger that follows a set point. It needs no touch sensors. It is
/// zero while the finger does not follow a set point.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct ContactEstimate {
    /// Torques of the surroundings on the joints, N cm. The slowly varying error of the model has been subtracted.
    pub torques: Vector3<f64>,
    /// The force of the surroundings on the fingertip that causes these torques, N, in the finger's frame. Near a
    /// singular pose, the component in the direction that causes no joint torques is reduced toward zero.
    pub force: Vector3<f64>,
    /// Whether the finger touches something. A contact begins when the force, and the torque at one or more joints,
    /// exceed their thresholds. Each threshold is lower while the finger touches something. A contact ends when the
    /// force, or the torque at every joint, falls below its lower threshold.
    pub touching: bool,
    /// Speed of the tip perpendicular to the force, cm/s, while the finger touches something. A speed above 0 means
    /// that the tip slides on the object, or moves it.
    pub slide: f64,
}

impl ContactEstimate {
    /// Returns the force of the fingertip on its surroundings, N, in the finger's frame. Planners get this force.
    pub fn force_on_surroundings(&self) -> Vector3<f64> {
        -self.force
    }
}
