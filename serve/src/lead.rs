//! The bound of the lead: how far a set point may be ahead of its finger.
//!
//! The spring of the fingertip makes the joint torques tau = J^T Kx J (theta_d - theta) (eq. 6 of the report). Because
//! of tau = J^T f (eq. 1), a force F at the tip gives joint i at most the torque F |J_i|, where J_i is column i of J.
//! The set point is moved back along the straight line to the finger until |tau_i| <= F |J_i| holds for every joint.
//! This multiplies theta_d - theta by one factor. The torques are linear in theta_d - theta, so the factor is the
//! smallest ratio F |J_i| / |tau_i|, or 1 if no ratio is below 1.

use sun2xp::nalgebra::{Matrix3, Vector3};

/// Returns the admitted fraction, 0 to 1, of the way from `joints` to `goal`, both in rad: the set point may be
/// this far along the way. `jacobian`, cm/rad, is that of the tip at `joints`, `stiffness` is Kx, N/cm, and `force` is
/// the largest force, N.
#[must_use]
pub fn admitted_part(
    jacobian: &Matrix3<f64>,
    stiffness: &Matrix3<f64>,
    joints: &Vector3<f64>,
    goal: &Vector3<f64>,
    force: f64,
) -> f64 {
    let torques = jacobian.transpose() * stiffness * jacobian * (goal - joints);
    (0..3).fold(1.0, |part: f64, joint| {
        let (torque, most) = (torques[joint].abs(), force * jacobian.column(joint).norm());
        if torque > most { part.min(most / torque) } else { part }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use sun2xp::model::configuration::Configuration;

    #[test]
    fn a_near_goal_is_admitted_and_a_far_one_only_in_part() {
        let finger = Configuration::default().fingers[0].clone();
        let joints = Vector3::new(0.1, 0.6, 1.0);
        let jacobian = finger.links().jacobian(&joints);
        let stiffness = Matrix3::identity() * 5.0;
        let part = |goal: Vector3<f64>, force| admitted_part(&jacobian, &stiffness, &joints, &goal, force);
        assert_eq!(part(joints, 10.0), 1.0);
        assert_eq!(part(joints.add_scalar(0.01), 10.0), 1.0);
        let goal = joints + Vector3::new(-0.6, 0.7, -0.9);
        let admitted = part(goal, 10.0);
        assert!((0.01..1.0).contains(&admitted), "{admitted}");
        // Half the force admits half the way, and the torque of the joint that decides is exactly at its bound.
        assert!((part(goal, 5.0) - admitted / 2.0).abs() < 1e-12);
        let torques = jacobian.transpose() * stiffness * jacobian * (goal - joints) * admitted;
        let used = (0..3).map(|joint| torques[joint].abs() / (10.0 * jacobian.column(joint).norm()));
        assert!((used.fold(0.0, f64::max) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_soft_finger_may_be_led_without_bound() {
        let jacobian = Matrix3::identity();
        let far = Vector3::new(1.0, 1.0, 1.0);
        assert_eq!(admitted_part(&jacobian, &Matrix3::zeros(), &Vector3::zeros(), &far, 1.0), 1.0);
        // A joint that the tip's force cannot turn gets no torque either, and does not bound the others.
        let singular = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, 0.0));
        let part = admitted_part(&singular, &Matrix3::identity(), &Vector3::zeros(), &(far * 4.0), 1.0);
        assert_eq!(part, 0.25);
    }
}
