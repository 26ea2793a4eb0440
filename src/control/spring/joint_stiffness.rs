//! The box K_theta: joint torques of the virtual spring, eqs. 1 to 6, with a damper beside it.

use crate::control::spring::spring_transition::Spring;
use crate::model::Links;
use nalgebra::{Matrix3, Matrix6, Matrix6x3, Vector3, Vector6};

/// Kx at which `rate_time` holds, N/cm.
const REFERENCE_STIFFNESS: f64 = 3.0;

/// Damping of a finger without stiffness, N cm s/rad: a few times what its joints have, a fifth of what a spring needs.
const LIMP_DAMPING: f64 = 0.2;

/// What joint 0's lever counts as at least, cm. On that axis no stiffness of the tip holds the joint, and near it a
/// force on the tip turns the joint away: one that presses the spring together by d toward the axis takes k d r of its
/// k r^2. With a least lever of 5 mm, deflections of up to 5 mm leave the joint held.
const LEAST_LEVER: f64 = 0.5;

/// tau = spring - z (B K_theta B + d) theta_dot, with K_theta = J^T K J, a diagonal B, a small d and the set point's
/// relative damping z.
///
/// J is the 6 x 3 Jacobian of the tip's motion, K the 6 x 6 stiffness of the contact: with the D x 6 selection S of
/// what the contact feels, S^T K S and J_c = S J give the D x D stiffness and the D x 3 Jacobian of eq. 6.
///
/// B^2 is beta where K_theta has its reference value, and is scaled with 1/sqrt(K_theta), joint by joint: the damping
/// ratio stays where Kx or the lever of a joint changes. A tip near the axis of joint 0, which then is soft, needs it.
///
/// Nearer to that axis than a least lever, r < rho, joint 0 has n^T K n (rho^2 - r^2) of its own beside, n being the
/// way that it moves the tip: a spring to theta_d that begins with nothing at rho, and that a spring without stiffness
/// there does not have.
#[derive(Clone, Debug)]
pub struct JointStiffness {
    links: Links,
    /// beta^2 times the diagonal of K_theta in a bent pose at the reference stiffness, s^2 N cm/rad.
    damping: Vector3<f64>,
}

/// A spring at a pose: found once a cycle, because its sines and products are what a cycle spends most on.
#[derive(Clone, Debug)]
pub(crate) struct PosedSpring<'a> {
    of: &'a JointStiffness,
    joints: Vector3<f64>,
    exact: f64,
    damping: f64,
    /// K J, before any scaling.
    stiffened: Matrix6x3<f64>,
    /// The part of its stiffness that the spring has.
    scale: f64,
    /// Of joint 0 where the tip is near its axis, before any scaling, N cm/rad.
    hold: f64,
    /// K_theta of eq. 6, N cm/rad.
    pub k_theta: Matrix3<f64>,
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
        let posed = self.posed(spring, joints);
        posed.torques(&spring.joints) - posed.damper(rates)
    }

    /// K_theta of eq. 6, N cm/rad.
    pub fn joint_stiffness(&self, spring: &Spring, joints: &Vector3<f64>) -> Matrix3<f64> {
        self.posed(spring, joints).k_theta
    }

    /// tau of the spring alone, N cm: K_theta (theta_d - theta) by eqs. 3 and 6, or J^T f by eqs. 1 and 2 with the
    /// deflection of the tip itself.
    pub fn spring(&self, spring: &Spring, joints: &Vector3<f64>) -> Vector3<f64> {
        self.posed(spring, joints).torques(&spring.joints)
    }

    /// A spring at joint angles, rad.
    pub(crate) fn posed(&self, spring: &Spring, joints: &Vector3<f64>) -> PosedSpring<'_> {
        let jacobian = self.links.spatial_jacobian(joints);
        let stiffened = spring.stiffness * jacobian;
        let mut k_theta = jacobian.tr_mul(&stiffened);
        let hold = hold(&spring.stiffness, &jacobian);
        k_theta[(0, 0)] += hold;
        let Spring { exact, damping, .. } = *spring;
        PosedSpring { of: self, joints: *joints, exact, damping, stiffened, scale: 1.0, hold, k_theta }
    }

    /// Translation (cm) and rotation vector (rad) from the tip's pose at `joints` to that at `desired`.
    ///
    /// The rotation is the whole one between the two poses, not J (theta_d - theta): like x_d - x it is a function of
    /// the two poses alone, so that the exact law has no deflection where the tip is in place, whichever way the joints
    /// went.
    fn deflection(&self, desired: &Vector3<f64>, joints: &Vector3<f64>) -> Vector6<f64> {
        let translation = self.links.tip(desired) - self.links.tip(joints);
        let rotation = self.links.tip_rotation(desired) * self.links.tip_rotation(joints).inverse();
        let rotation = rotation.scaled_axis();
        let mut deflection = Vector6::zeros();
        deflection.fixed_rows_mut::<3>(0).copy_from(&translation);
        deflection.fixed_rows_mut::<3>(3).copy_from(&rotation);
        deflection
    }
}

/// What holds joint 0 beside the spring of the tip, N cm/rad: K and J as above.
fn hold(stiffness: &Matrix6<f64>, jacobian: &Matrix6x3<f64>) -> f64 {
    let turned = jacobian.fixed_view::<3, 1>(0, 0);
    let lacking = LEAST_LEVER * LEAST_LEVER - turned.norm_squared();
    if lacking <= 0.0 {
        return 0.0;
    }
    // Joint 0 moves the tip along the axis of joints 1 and 2, on its own axis too, where J has no direction left.
    let way = jacobian.fixed_view::<3, 1>(3, 1);
    way.dot(&(stiffness.fixed_view::<3, 3>(0, 0) * way)) * lacking
}

impl PosedSpring<'_> {
    /// Leaves this part of the stiffness.
    pub fn soften(&mut self, part: f64) {
        self.scale *= part;
        self.k_theta *= part;
    }

    /// tau, N cm, of the spring between `desired`, rad, and the joints.
    pub fn torques(&self, desired: &Vector3<f64>) -> Vector3<f64> {
        let mut torques = Vector3::zeros();
        if self.exact < 1.0 {
            torques += self.k_theta * (desired - self.joints) * (1.0 - self.exact);
        }
        if self.exact > 0.0 {
            // K is symmetric: J^T K d = (K J)^T d.
            let deflection = self.of.deflection(desired, &self.joints);
            let mut exact = self.stiffened.tr_mul(&deflection);
            exact[0] += self.hold * (desired[0] - self.joints[0]);
            torques += exact * (self.scale * self.exact);
        }
        torques
    }

    /// tau of the damper, N cm, at joint rates, rad/s: its matrix is symmetric, positive definite, and in proportion to
    /// the spring's relative damping.
    pub fn damper(&self, rates: &Vector3<f64>) -> Vector3<f64> {
        // beta^2 K_ref / K_jj to the power 1/4; without stiffness in a joint there is nothing to damp it with.
        let stiffness = self.k_theta.diagonal();
        let b = stiffness.zip_map(&self.of.damping, |k, damping| (damping / k.max(1e-6)).sqrt().sqrt());
        let damped = (self.k_theta * rates.component_mul(&b)).component_mul(&b) + rates * LIMP_DAMPING;
        damped * self.damping
    }
}
