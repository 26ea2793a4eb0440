//! The box K_theta: joint torques of the virtual spring, eqs. 3 and 6, with a damper beside it.

use super::signals::SetPoint;
use crate::model::Links;
use nalgebra::Vector3;

/// Kx at which `rate_time` holds, N/cm.
const REFERENCE_STIFFNESS: f64 = 3.0;

/// Damping of a finger without stiffness, N cm s/rad: a few times what its joints have, a fifth of what a spring needs.
const LIMP_DAMPING: f64 = 0.2;

/// tau = K_theta (theta_d - theta) - (B K_theta B + d) theta_dot, with K_theta = J^T Kx J, a diagonal B and a small d.
///
/// B^2 is beta where K_theta has its reference value, and is scaled with 1/sqrt(K_theta), joint by joint: the damping ratio
/// stays where Kx or the lever of a joint changes. A tip near the axis of joint 0, which then is soft, needs it.
#[derive(Clone, Debug)]
pub struct JointStiffness {
    links: Links,
    /// beta^2 times the diagonal of K_theta in a bent pose at the reference stiffness, s^2 N cm/rad.
    damping: Vector3<f64>,
}

impl JointStiffness {
    /// `rate_time`: beta at 3 N/cm, s.
    pub fn new(links: Links, rate_time: f64) -> Self {
        let [l0, l1, l2] = links.0;
        let levers = Vector3::new((l0 + l1).powi(2), l1 * l1 + l2 * l2, l2 * l2);
        Self { links, damping: levers * (REFERENCE_STIFFNESS * rate_time * rate_time) }
    }

    /// tau, N cm, at joint angles (rad) and rates (rad/s).
    pub fn torques(&self, set_point: &SetPoint, joints: &Vector3<f64>, rates: &Vector3<f64>) -> Vector3<f64> {
        let jacobian = self.links.jacobian(joints);
        let k_theta = jacobian.tr_mul(&(set_point.stiffness * jacobian)); // eq. 6
        // beta^2 K_ref / K_jj to the power 1/4; without stiffness in a joint there is nothing to damp it with.
        let root = k_theta.diagonal().zip_map(&self.damping, |k, damping| (damping / k.max(1e-6)).sqrt().sqrt());
        let damped = root.component_mul(rates);
        let damping = root.component_mul(&(k_theta * damped)) + rates * LIMP_DAMPING;
        k_theta * (set_point.joints - joints) - damping
    }
}
