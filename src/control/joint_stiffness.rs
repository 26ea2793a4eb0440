//! The box K_theta: joint torques of the virtual spring, eqs. 1 to 6, with a damper beside it.

use super::spring_transition::Spring;
use crate::model::Links;
use nalgebra::{Matrix3, Vector3, Vector6};

/// Kx at which `rate_time` holds, N/cm.
const REFERENCE_STIFFNESS: f64 = 3.0;

/// Damping of a finger without stiffness, N cm s/rad: a few times what its joints have, a fifth of what a spring needs.
const LIMP_DAMPING: f64 = 0.2;

/// tau = spring - z (B K_theta B + d) theta_dot, with K_theta = J^T K J, a diagonal B, a small d and the set point's relative
/// damping z.
///
/// J is the 6 x 3 Jacobian of the tip's motion, K the 6 x 6 stiffness of the contact: with the D x 6 selection S of what the
/// contact feels, S^T K S and J_c = S J give the D x D stiffness and the D x 3 Jacobian of eq. 6.
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

    /// tau of spring and damper, N cm, at joint angles (rad) and rates (rad/s).
    pub fn torques(&self, spring: &Spring, joints: &Vector3<f64>, rates: &Vector3<f64>) -> Vector3<f64> {
        let damping = self.damping(&self.joint_stiffness(spring, joints), spring.damping);
        self.spring(spring, joints) - damping * rates
    }

    /// K_theta of eq. 6, N cm/rad.
    pub fn joint_stiffness(&self, spring: &Spring, joints: &Vector3<f64>) -> Matrix3<f64> {
        let jacobian = self.links.spatial_jacobian(joints);
        jacobian.tr_mul(&(spring.stiffness * jacobian))
    }

    /// tau of the spring alone, N cm: K_theta (theta_d - theta) by eqs. 3 and 6, or J^T f by eqs. 1 and 2 with the deflection
    /// of the tip itself.
    pub fn spring(&self, spring: &Spring, joints: &Vector3<f64>) -> Vector3<f64> {
        let jacobian = self.links.spatial_jacobian(joints);
        let mut deflection = Vector6::zeros();
        if spring.exact < 1.0 {
            deflection += jacobian * (spring.joints - joints) * (1.0 - spring.exact);
        }
        if spring.exact > 0.0 {
            deflection += self.deflection(&spring.joints, joints) * spring.exact;
        }
        jacobian.tr_mul(&(spring.stiffness * deflection))
    }

    /// Translation (cm) and rotation vector (rad) from the tip's pose at `joints` to that at `desired`.
    ///
    /// The rotation is the whole one between the two poses, not J (theta_d - theta): like x_d - x it is a function of the two
    /// poses alone, so that the exact law has no deflection where the tip is in place, whichever way the joints went.
    fn deflection(&self, desired: &Vector3<f64>, joints: &Vector3<f64>) -> Vector6<f64> {
        let translation = self.links.tip(desired) - self.links.tip(joints);
        let rotation = self.links.tip_rotation(desired) * self.links.tip_rotation(joints).inverse();
        let rotation = rotation.scaled_axis();
        let mut deflection = Vector6::zeros();
        deflection.fixed_rows_mut::<3>(0).copy_from(&translation);
        deflection.fixed_rows_mut::<3>(3).copy_from(&rotation);
        deflection
    }

    /// The damper of a finger with `k_theta`, N cm s/rad: symmetric, positive definite, in proportion to `ratio`.
    pub fn damping(&self, k_theta: &Matrix3<f64>, ratio: f64) -> Matrix3<f64> {
        // beta^2 K_ref / K_jj to the power 1/4; without stiffness in a joint there is nothing to damp it with.
        let root = k_theta.diagonal().zip_map(&self.damping, |k, damping| (damping / k.max(1e-6)).sqrt().sqrt());
        let b = Matrix3::from_diagonal(&root);
        (b * k_theta * b + Matrix3::identity() * LIMP_DAMPING) * ratio
    }
}
