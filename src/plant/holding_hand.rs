//! A person's hand that holds the finger in a pose, firmly but elastically.

use nalgebra::Vector3;

/// Stiffness, N m/rad. A push of 0.25 N at the tip moves a joint by a third of a degree.
const STIFFNESS: f64 = 3.0;
/// Damping, N m s/rad.
const DAMPING: f64 = 0.02;

/// A spring and a damper at every joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct HoldingHand {
    /// Held joint angles, rad.
    pose: Vector3<f64>,
}

impl HoldingHand {
    /// `pose`: joint angles, rad.
    pub fn new(pose: Vector3<f64>) -> Self {
        Self { pose }
    }

    /// Returns the torques on the joints, N m.
    pub fn torque(&self, theta: &Vector3<f64>, rate: &Vector3<f64>) -> Vector3<f64> {
        (self.pose - theta) * STIFFNESS - rate * DAMPING
    }

    /// Returns the elastic energy, J.
    pub fn energy(&self, theta: &Vector3<f64>) -> f64 {
        0.5 * STIFFNESS * (self.pose - theta).norm_squared()
    }
}
