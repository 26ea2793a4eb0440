//! A soft spring in joint space with a damper: it holds and leads a finger whose stiffness nobody has asked for.

use crate::model::Links;
use nalgebra::Vector3;

/// N cm/rad: less than the softest spring that the tendon controllers are tuned for gives a bent finger.
pub(crate) const HOLDING_STIFFNESS: f64 = 30.0;

/// N cm s/rad for every cm of finger beyond the joint, whose inertia must not swing on the spring.
const DAMPING: f64 = 0.2;

/// tau = k (theta_d - theta) - d (theta_dot - theta_dot_d).
#[derive(Clone, Debug)]
pub(crate) struct JointHold {
    /// N cm s/rad.
    damping: Vector3<f64>,
}

impl JointHold {
    pub fn new(links: Links) -> Self {
        let [l0, l1, l2] = links.0;
        Self { damping: Vector3::new(l0 + l1 + l2, l1 + l2, l2) * DAMPING }
    }

    /// N cm; `deflection`: theta_d - theta, rad; `slip`: theta_dot - theta_dot_d, rad/s. The spring's part of every
    /// joint is at most `limit`.
    pub fn torques(&self, deflection: &Vector3<f64>, slip: &Vector3<f64>, limit: f64) -> Vector3<f64> {
        let spring = (deflection * HOLDING_STIFFNESS).map(|torque| torque.clamp(-limit, limit));
        spring - slip.component_mul(&self.damping)
    }
}
