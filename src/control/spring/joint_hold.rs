//! A soft spring and damper in joint space. It holds or leads a finger during a calibration.

use crate::model::Links;
use nalgebra::Vector3;

/// Stiffness of each joint, N cm/rad. The joints of a bent finger are stiffer even with the softest Kx for which the
/// tendon controllers are tuned.
pub(crate) const HOLDING_STIFFNESS: f64 = 30.0;

/// Damping of a joint, N cm s/rad for each cm of finger between the joint and the tip. It keeps the inertia of the
/// finger from oscillating on the spring.
const DAMPING: f64 = 0.2;

/// tau = k (theta_d - theta) - d (theta_dot - theta_dot_d).
#[derive(Clone, Debug)]
pub(crate) struct JointHold {
    /// Damping of each joint, N cm s/rad.
    damping: Vector3<f64>,
}

impl JointHold {
    pub fn new(links: Links) -> Self {
        let [l0, l1, l2] = links.0;
        Self { damping: Vector3::new(l0 + l1 + l2, l1 + l2, l2) * DAMPING }
    }

    /// Returns the torques, N cm. `deflection` is theta_d - theta, rad; `slip` is theta_dot - theta_dot_d, rad/s. The
    /// spring torque of every joint is clamped to `limit`, N cm.
    pub fn torques(&self, deflection: &Vector3<f64>, slip: &Vector3<f64>, limit: f64) -> Vector3<f64> {
        let spring = (deflection * HOLDING_STIFFNESS).map(|torque| torque.clamp(-limit, limit));
        spring - slip.component_mul(&self.damping)
    }
}
