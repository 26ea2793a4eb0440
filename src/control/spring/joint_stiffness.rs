//! The block K_theta of Figure 9 of the report: joint torques of the virtual spring (eqs. 1 to 6), and of a damper in
//! parallel.

use crate::control::spring::spring_transition::Spring;
use crate::model::{JointSines, Links};
use nalgebra::{Matrix3, Matrix6, Matrix6x3, Vector3};

/// Stiffness Kx, N/cm, at which beta equals `controller.rate_time` in a bent finger. beta is the ratio of the damping
/// of a joint to its stiffness.
const REFERENCE_STIFFNESS: f64 = 3.0;

/// Damping of a finger without stiffness, N cm s/rad. It is a few times the viscous friction of its joints, and a fifth
/// of the damping that a spring needs.
const LIMP_DAMPING: f64 = 0.2;

/// Minimum lever of joint 0, cm. With the tip on the axis of joint 0, no stiffness of the tip holds the joint. With the
/// tip near the axis, a force on the tip can turn the joint out of its pose. A spring of stiffness k at the lever r
/// gives the joint the stiffness k r^2. A force that moves the tip by d toward the axis reduces the stiffness of the
/// joint by k d r. With a minimum lever of 5 mm, the joint is held at deflections of up to 5 mm.
const LEAST_LEVER: f64 = 0.5;

/// Angle of joint 2, rad, within which the finger counts as straight. It is below the lower limit of joint 2 of the
/// default finger, 5 degrees.
const STRAIGHT: f64 = 0.08;

/// Stiffness of the joint spring, divided by the diagonal of K_theta. [`JointStiffness`] describes this spring, which
/// has no coupling between the joints. With a factor of 1, the joint spring could be stiffer than the pose supports.
const LEADING: f64 = 0.5;

/// tau = spring - z (B K_theta B + d) theta_dot, with K_theta = J^T K J, a diagonal B, a small d, and the relative
/// damping z of the set point.
///
/// J is the 6 x 3 Jacobian of the tip's motion, and K the 6 x 6 stiffness of the contact. For a contact that transmits
/// D directions, selected by a D x 6 matrix S, K is S^T K_c S with the D x D stiffness K_c. The D x 3 Jacobian of eq. 6
/// is then S J, because K_theta = (S J)^T K_c (S J).
///
/// B^2 contains beta of each joint. beta equals `rate_time` where K_theta has its reference value. It is proportional
/// to 1/sqrt(K_theta), so that the damping ratio stays constant if Kx or the lever of a joint changes. A tip near the
/// axis of joint 0 needs this, because that joint is then soft.
///
/// If the lever r of joint 0 is less than the minimum lever rho, joint 0 has an additional spring to theta_d with the
/// stiffness n^T K n (rho^2 - r^2). n is the direction in which the joint moves the tip. The stiffness starts from zero
/// at r = rho, and is zero if K has no stiffness along n.
///
/// There are two laws. The report's law is K_theta (theta_d - theta). The exact law is J^T f, where f is K times the
/// deflection of the tip itself. A tip position has two joint solutions, which bend joint 2 to opposite sides, and the
/// exact law does not distinguish them. While joint 2 is bent to the opposite side from theta_d, a spring between the
/// joint angles and theta_d therefore replaces the spring of the exact law. This joint spring has no singular pose, and
/// leads the finger through the straight pose.
#[derive(Clone, Debug)]
pub struct JointStiffness {
    links: Links,
    /// beta^2 times the diagonal of K_theta in a bent pose at the reference stiffness, s^2 N cm/rad.
    damping: Vector3<f64>,
}

/// A spring at a pose. It is computed only once in a cycle, because its sines and products are the most expensive part
/// of a cycle.
#[derive(Clone, Debug)]
pub(crate) struct PosedSpring<'a> {
    of: &'a JointStiffness,
    joints: Vector3<f64>,
    exact: f64,
    damping: f64,
    /// Position of the tip, cm.
    tip: Vector3<f64>,
    /// K J, before any scaling.
    stiffened: Matrix6x3<f64>,
    /// Factor on the stiffness of the spring. [`PosedSpring::soften`] reduces it.
    scale: f64,
    /// Additional stiffness of joint 0 with the tip near its axis, before any scaling, N cm/rad.
    hold: f64,
    /// K_theta of eq. 6 plus `hold` for joint 0, N cm/rad.
    pub k_theta: Matrix3<f64>,
}

impl JointStiffness {
    /// Constructs the spring law of a finger. `rate_time` is beta at 3 N/cm, s.
    pub fn new(links: Links, rate_time: f64) -> Self {
        let [l0, l1, l2] = links.0;
        let levers = Vector3::new((l0 + l1).powi(2), l1 * l1 + l2 * l2, l2 * l2);
        Self { links, damping: levers * (REFERENCE_STIFFNESS * rate_time * rate_time) }
    }

    /// Returns tau of spring and damper, N cm, at joint angles (rad) and rates (rad/s).
    pub fn torques(&self, spring: &Spring, joints: &Vector3<f64>, rates: &Vector3<f64>) -> Vector3<f64> {
        let posed = self.posed(spring, joints);
        posed.torques(&spring.joints) - posed.damper(rates)
    }

    /// Returns K_theta of eq. 6 plus the additional stiffness of joint 0 with the tip near its axis, N cm/rad.
    pub fn joint_stiffness(&self, spring: &Spring, joints: &Vector3<f64>) -> Matrix3<f64> {
        self.joint_stiffness_at(spring, &JointSines::of(joints))
    }

    /// Returns [`JointStiffness::joint_stiffness`] at a pose whose sines the caller has.
    pub(crate) fn joint_stiffness_at(&self, spring: &Spring, pose: &JointSines) -> Matrix3<f64> {
        let jacobian = self.links.spatial_jacobian_at(pose);
        k_theta(&jacobian, &(spring.stiffness * jacobian), hold(&spring.stiffness, &jacobian))
    }

    /// Returns tau of the spring alone, N cm. The report's law is K_theta (theta_d - theta), eqs. 3 and 6. The exact
    /// law is J^T f, eqs. 1 and 2, where f is K times the deflection of the tip itself.
    pub fn spring(&self, spring: &Spring, joints: &Vector3<f64>) -> Vector3<f64> {
        self.posed(spring, joints).torques(&spring.joints)
    }

    /// Computes a spring at joint angles, rad.
    #[inline]
    pub(crate) fn posed(&self, spring: &Spring, joints: &Vector3<f64>) -> PosedSpring<'_> {
        self.posed_at(spring, joints, &JointSines::of(joints))
    }

    /// Returns [`JointStiffness::posed`] at a pose whose sines the caller has.
    #[inline]
    pub(crate) fn posed_at(&self, spring: &Spring, joints: &Vector3<f64>, pose: &JointSines) -> PosedSpring<'_> {
        let jacobian = self.links.spatial_jacobian_at(pose);
        let stiffened = spring.stiffness * jacobian;
        let hold = hold(&spring.stiffness, &jacobian);
        let k_theta = k_theta(&jacobian, &stiffened, hold);
        let Spring { exact, damping, .. } = *spring;
        let tip = tip(&jacobian);
        PosedSpring { of: self, joints: *joints, exact, damping, tip, stiffened, scale: 1.0, hold, k_theta }
    }
}

/// Returns K_theta, N cm/rad, from J, from K J, and from the additional stiffness of joint 0.
#[inline]
fn k_theta(jacobian: &Matrix6x3<f64>, stiffened: &Matrix6x3<f64>, hold: f64) -> Matrix3<f64> {
    let mut k_theta = jacobian.tr_mul(stiffened);
    k_theta[(0, 0)] += hold;
    k_theta
}

/// Returns the position of the tip, cm, from the Jacobian of its motion, which already contains the sines of the pose.
/// Joint 0 turns the tip about the y axis, so column 0 contains x and z of the tip. A rotation of joint 1 changes the
/// distance between the tip and the y axis. The derivative of this distance with respect to the angle is y of the tip,
/// here called the height.
fn tip(jacobian: &Matrix6x3<f64>) -> Vector3<f64> {
    let (cosine, sine) = (jacobian[(3, 1)], -jacobian[(5, 1)]);
    let height = sine * jacobian[(0, 1)] + cosine * jacobian[(2, 1)];
    Vector3::new(-jacobian[(2, 0)], height, jacobian[(0, 0)])
}

/// Returns the stiffness that holds joint 0 in addition to the spring of the tip, N cm/rad. [`JointStiffness`] defines
/// K and J.
fn hold(stiffness: &Matrix6<f64>, jacobian: &Matrix6x3<f64>) -> f64 {
    let turned = jacobian.fixed_view::<3, 1>(0, 0);
    let lacking = LEAST_LEVER * LEAST_LEVER - turned.norm_squared();
    if lacking <= 0.0 {
        return 0.0;
    }
    // n is the axis of joints 1 and 2, because joint 0 moves the tip along that axis. This is also valid for a tip on
    // the axis of joint 0, where the translation in column 0 of J is zero.
    let way = jacobian.fixed_view::<3, 1>(3, 1);
    way.dot(&(stiffness.fixed_view::<3, 3>(0, 0) * way)) * lacking
}

/// Returns whether joint 2 is bent to the opposite side from `desired`: 0 if it is not, and 1 if it is. If either angle
/// is near the straight pose, the result is between 0 and 1, so that the torque has no jump. Both angles are in rad.
fn bent_to_the_other_side(desired: f64, joint: f64) -> f64 {
    let bent = desired.abs().min(STRAIGHT);
    // The finger has left the straight pose when joint 2 is halfway to `desired`, or halfway to `STRAIGHT` if `desired`
    // is beyond `STRAIGHT`.
    let missing = 0.5 * bent - joint * desired.signum();
    (missing / STRAIGHT).clamp(0.0, 1.0) * (bent / STRAIGHT)
}

impl PosedSpring<'_> {
    /// Scales the stiffness by `part`.
    pub fn soften(&mut self, part: f64) {
        self.scale *= part;
        self.k_theta *= part;
    }

    /// Returns tau, N cm, of the spring between `desired`, rad, and the joints.
    #[inline]
    pub fn torques(&self, desired: &Vector3<f64>) -> Vector3<f64> {
        let mut torques = Vector3::zeros();
        if self.exact < 1.0 {
            torques += self.k_theta * (desired - self.joints) * (1.0 - self.exact);
        }
        if self.exact > 0.0 {
            let mut exact = self.force_torques(desired);
            exact[0] += self.hold * (desired[0] - self.joints[0]);
            let other = bent_to_the_other_side(desired[2], self.joints[2]);
            torques += exact * (self.scale * self.exact * (1.0 - other));
            if other > 0.0 {
                let leading = self.k_theta.diagonal().component_mul(&(desired - self.joints));
                torques += leading * (LEADING * self.exact * other);
            }
        }
        torques
    }

    /// Returns J^T K d, N cm, without `scale`. d is the displacement from the present pose of the tip to its pose at
    /// the joint angles `desired`, rad.
    fn force_torques(&self, desired: &Vector3<f64>) -> Vector3<f64> {
        // K is symmetric: J^T K d = (K J)^T d.
        let translation = self.of.links.tip(desired) - self.tip;
        let torques = self.stiffened.fixed_view::<3, 3>(0, 0).tr_mul(&translation);
        let rotational = self.stiffened.fixed_view::<3, 3>(3, 0);
        // Few contacts have a rotational stiffness, and the rotation is the most expensive part of the law.
        if rotational.iter().all(|&entry| entry == 0.0) {
            return torques;
        }
        // The deflection is the rotation between the two poses, and not J (theta_d - theta). Like x_d - x it is zero
        // where the tip is at the desired pose, for any joint solution.
        torques + rotational.tr_mul(&self.of.links.rotation_between(&self.joints, desired))
    }

    /// Returns tau of the damper, N cm, at joint rates, rad/s. Its matrix is symmetric, positive definite, and
    /// proportional to the spring's relative damping.
    pub fn damper(&self, rates: &Vector3<f64>) -> Vector3<f64> {
        // b = sqrt(beta) = (rate_time^2 K_ref / K_jj)^(1/4), where K_ref is the reference value of K_jj. Without
        // stiffness the lower bound of K_jj avoids a division by zero, and the product with K_theta is zero.
        let stiffness = self.k_theta.diagonal();
        let b = stiffness.zip_map(&self.of.damping, |k, damping| (damping / k.max(1e-6)).sqrt().sqrt());
        let damped = (self.k_theta * rates.component_mul(&b)).component_mul(&b) + rates * LIMP_DAMPING;
        damped * self.damping
    }
}
