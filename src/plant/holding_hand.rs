//! A person's hand that holds the finger in a pose: firm, but no vice.

use nalgebra::Vector3;

/// N m/rad: a push of 0.25 N at the tip moves a joint by a third of a degree.
const STIFFNESS: f64 = 3.0;
/// N m s/rad.
const DAMPING: f64 = 0.02;

/// A spring and a damper at every joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct HoldingHand {
    /// rad.
    pose: Vector3<f64>,
}

impl HoldingHand {
    /// `pose`: joint angles, rad.
    pub fn new(pose: Vector3<f64>) -> Self {
        Self { pose }
    }

    /// Torques on the joints, N m.
    pub fn torque(&self, theta: &Vector3<f64>, rate: &Vector3<f64>) -> Vector3<f64> {
        (self.pose - theta) * STIFFNESS - rate * DAMPING
    }

    /// Elastic energy, J.
    pub fn energy(&self, theta: &Vector3<f64>) -> f64 {
        0.5 * STIFFNESS * (self.pose - theta).norm_squared()
    }
}
