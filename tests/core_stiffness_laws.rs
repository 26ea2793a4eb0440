//! Tests both stiffness laws, and the three contact types of section 4.2 of the report, against their definitions.

use nalgebra::{Matrix3, Matrix4, SMatrix, Vector3, Vector6};
use proptest::prelude::*;
use std::f64::consts::FRAC_PI_2;
use sun2xp::control::{JointStiffness, Law, SetPoint};
use sun2xp::model::{Contact, Links};

const LINKS: Links = Links([3.556, 5.080, 4.000]);

fn law() -> JointStiffness {
    JointStiffness::new(LINKS, 0.015)
}

fn set_point(joints: Vector3<f64>, contact: &Contact, law: Law) -> SetPoint {
    SetPoint { joints, law, stiffness: *contact.stiffness(), damping: 1.0, motion: None, joint_spring: None }
}

fn soft_finger(root: [f64; 16], normal: [f64; 3]) -> (Matrix4<f64>, Vector3<f64>, Contact) {
    let root = Matrix4::from_row_slice(&root);
    let k = root * root.transpose();
    let normal = Vector3::from(normal).normalize();
    (k, normal, Contact::soft_finger(k, normal).expect("a spring"))
}

/// Joint angles with which the tip is more than 5 mm off the axis of joint 0. Nearer to this axis, joint 0 has an
/// additional spring, which the formulas of these tests do not contain.
fn theta() -> impl Strategy<Value = Vector3<f64>> {
    (-1.0..1.0f64, -0.5..1.7f64, 0.1..2.0f64)
        .prop_map(|(a, b, c)| Vector3::new(a, b, c))
        .prop_filter("5 mm off the axis", |theta| LINKS.reach(theta).abs() > 0.5)
}

/// If the tip is within 5 mm of the axis of joint 0, both laws hold joint 0 as if the lever were 5 mm long. A spring
/// that has no stiffness in the direction in which joint 0 moves the tip does not hold joint 0. The torque has no jump
/// at 5 mm.
#[test]
fn near_its_axis_joint_0_is_held() {
    // Joint 1 is at 90 degrees, so the reach is l0 + l2 C12, where C12 is the cosine of the sum of the angles of joints
    // 1 and 2. At a reach of 0 the tip is on the axis.
    let folded = |reach: f64| Vector3::new(0.3, FRAC_PI_2, ((reach - 3.556) / 4.0).acos() - FRAC_PI_2);
    let away = Vector3::new(0.1, 0.0, 0.0);
    for law_of in [Law::Report, Law::Exact] {
        for reach in [-0.4, 0.0, 0.2, 0.499] {
            let theta = folded(reach);
            assert!((LINKS.reach(&theta) - reach).abs() < 1e-12);
            let torque = |kx: Matrix3<f64>| {
                let contact = Contact::hard_finger(kx).expect("a spring");
                law().spring(&set_point(theta + away, &contact, law_of).into(), &theta)
            };
            let held = torque(Matrix3::identity() * 3.0);
            assert!((held[0] - 3.0 * 0.25 * 0.1).abs() < 2e-3, "{law_of:?} at {reach} cm: {held}");
            assert!(held.fixed_rows::<2>(1).amax() < 0.1);
            let way = Vector3::new(theta[0].cos(), 0.0, -theta[0].sin());
            assert!(torque(Matrix3::identity() * 3.0 - way * way.transpose() * 3.0)[0].abs() < 2e-3);
        }
        let [within, beyond] = [0.5 - 1e-9, 0.5 + 1e-9].map(|reach| {
            let contact = Contact::hard_finger(Matrix3::identity() * 3.0).expect("a spring");
            law().spring(&set_point(folded(reach) + away, &contact, law_of).into(), &folded(reach))
        });
        assert!((within - beyond).amax() < 1e-6);
    }
}

fn normal() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-1.0..1.0f64).prop_filter("a direction", |n| Vector3::from(*n).norm() > 0.1)
}

proptest! {
    /// The rotational Jacobian is the derivative of the last link's rotation. The last link ends at the tip.
    #[test]
    fn rotational_jacobian_is_the_derivative_of_the_tip_frame(theta in theta()) {
        let jacobian = LINKS.spatial_jacobian(&theta);
        for joint in 0..3 {
            let mut step = Vector3::zeros();
            step[joint] = 1e-5;
            let turned = LINKS.tip_rotation(&(theta + step)) * LINKS.tip_rotation(&(theta - step)).inverse();
            let difference = turned.scaled_axis() / 2e-5;
            prop_assert!((jacobian.fixed_view::<3, 1>(3, joint) - difference).amax() < 1e-8);
        }
        prop_assert_eq!(jacobian.fixed_view::<3, 3>(0, 0), LINKS.jacobian(&theta));
        let shorter = Links([3.556, 5.080, 0.0]);
        let link = LINKS.tip(&theta) - shorter.tip(&theta);
        prop_assert!((LINKS.tip_rotation(&theta) * Vector3::new(0.0, 0.0, 4.0) - link).amax() < 1e-12);
    }

    /// Eq. 6 for D = 4: K_theta = J_c^T K J_c, where J_c is the 4 x 3 Jacobian of two motions: the translation of the
    /// tip, and its rotation about the normal.
    #[test]
    fn soft_finger_is_eq_6_with_its_4_by_3_jacobian(
        theta in theta(), root in prop::array::uniform16(-1.5..1.5f64), n in normal(),
        away in prop::array::uniform3(-0.3..0.3f64),
    ) {
        let (k, normal, contact) = soft_finger(root, n);
        let spatial = LINKS.spatial_jacobian(&theta);
        let mut jacobian = SMatrix::<f64, 4, 3>::zeros();
        jacobian.fixed_view_mut::<3, 3>(0, 0).copy_from(&LINKS.jacobian(&theta));
        jacobian.set_row(3, &(normal.transpose() * spatial.fixed_view::<3, 3>(3, 0)));
        let expected = jacobian.transpose() * k * jacobian;
        let away = Vector3::from(away);
        let point = set_point(theta + away, &contact, Law::Report);
        prop_assert!((law().joint_stiffness(&point.into(), &theta) - expected).amax() < 1e-9);
        prop_assert!((law().spring(&point.into(), &theta) - expected * away).amax() < 1e-9);
    }

    /// tau = J^T f at any deflection, where f = Kx (x_d - x) is the force of the spring on the tip. If the tip is at
    /// its anchor, the torque is zero.
    #[test]
    fn exact_law_is_the_spring_at_any_deflection(
        theta in theta(), desired in theta(), root in prop::array::uniform9(-1.5..1.5f64),
    ) {
        let root = Matrix3::from_row_slice(&root);
        let kx = root * root.transpose();
        let contact = Contact::hard_finger(kx).expect("a spring");
        let force = kx * (LINKS.tip(&desired) - LINKS.tip(&theta));
        let point = set_point(desired, &contact, Law::Exact);
        prop_assert!((law().spring(&point.into(), &theta) - LINKS.jacobian(&theta).transpose() * force).amax() < 1e-9);
        prop_assert!(law().spring(&point.into(), &desired).amax() < 1e-12);
    }

    /// A joint spring leads the finger through the straight pose. The torque is continuous in the angles of the anchor
    /// and of the finger near this pose, where the joint spring replaces the spring of the exact law.
    #[test]
    fn the_exact_law_has_no_jump_at_the_straight_pose(
        theta in prop::array::uniform3(-0.3..0.3f64), desired in prop::array::uniform3(-0.3..0.3f64),
        moves in prop::array::uniform6(-1e-7..1e-7f64),
    ) {
        let [mut theta, mut desired] = [theta, desired].map(Vector3::from);
        let contact = Contact::hard_finger(Matrix3::identity() * 3.0).expect("a spring");
        let torque = |theta: &Vector3<f64>, desired: Vector3<f64>| {
            law().spring(&set_point(desired, &contact, Law::Exact).into(), theta)
        };
        // The finger is straight if the angle of joint 2 is zero.
        for of_joint_2 in [(theta[2], desired[2]), (0.0, desired[2]), (theta[2], 0.0)] {
            (theta[2], desired[2]) = of_joint_2;
            let moved = [0, 3].map(|first| Vector3::from_row_slice(&moves[first..first + 3]));
            let change = torque(&(theta + moved[0]), desired + moved[1]) - torque(&theta, desired);
            prop_assert!(change.amax() < 1e-3, "{change}");
        }
    }

    /// If joint 2 is bent to the opposite side from the set point, a torque pushes it toward the set point, although
    /// the tip is already where the set point puts it.
    #[test]
    fn the_other_joint_solution_is_not_at_rest(theta in theta()) {
        prop_assume!(theta[2] > 0.2);
        let [_, l1, l2] = LINKS.0;
        // Mirrors joint 2 at the line from joint 1 to the tip.
        let turned = 2.0 * (l2 * theta[2].sin()).atan2(l1 + l2 * theta[2].cos());
        let other = Vector3::new(theta[0], theta[1] + turned, -theta[2]);
        prop_assert!((LINKS.tip(&other) - LINKS.tip(&theta)).norm() < 1e-12);
        let contact = Contact::hard_finger(Matrix3::identity() * 3.0).expect("a spring");
        prop_assert!(law().spring(&set_point(other, &contact, Law::Exact).into(), &theta)[2] < -5.0);
        prop_assert!(law().spring(&set_point(theta, &contact, Law::Exact).into(), &other)[2] > 5.0);
    }

    /// Both laws agree for a small deflection, rotation included: their difference is of second order.
    #[test]
    fn both_laws_agree_to_first_order(
        theta in theta(), root in prop::array::uniform16(-1.5..1.5f64), n in normal(),
        away in prop::array::uniform3(-1.0..1.0f64),
    ) {
        let (_, _, contact) = soft_finger(root, n);
        let apart = |size: f64| {
            let desired = theta + Vector3::from(away) * size;
            let [exact, report] = [Law::Exact, Law::Report]
                .map(|which| law().spring(&set_point(desired, &contact, which).into(), &theta));
            (exact - report).norm()
        };
        prop_assert!(apart(1e-4) <= apart(1e-3) * 0.02 + 1e-9);
    }

    /// The torque of the damper is proportional to the planner's ratio, and removes energy. The finger is at its set
    /// point, so the spring exerts no torque.
    #[test]
    fn damping_is_in_proportion_to_its_ratio(
        theta in theta(), rates in prop::array::uniform3(-3.0..3.0f64), ratio in 0.2..3.0f64,
        root in prop::array::uniform16(-1.5..1.5f64), n in normal(),
    ) {
        let (_, _, contact) = soft_finger(root, n);
        let plain = set_point(theta, &contact, Law::Exact);
        let rates = Vector3::from(rates);
        let one = law().torques(&plain.into(), &theta, &rates);
        let scaled = law().torques(&SetPoint { damping: ratio, ..plain }.into(), &theta, &rates);
        prop_assert!((scaled - one * ratio).amax() < 1e-9);
        prop_assert!(one.dot(&rates) <= 0.0);
    }
}

/// The finger is turned about the normal only, and the spring turns it back. The soft finger has no translational
/// stiffness, so only its rotational stiffness exerts a torque.
#[test]
fn torsion_alone_turns_the_tip_back_about_the_normal() {
    let k = Matrix4::from_diagonal(&nalgebra::Vector4::new(0.0, 0.0, 0.0, 10.0));
    let contact = Contact::soft_finger(k, Vector3::y()).expect("a spring");
    let theta = Vector3::new(0.1, 0.4, 0.0);
    let desired = Vector3::new(0.4, 0.4, 0.0);
    let report = law().spring(&set_point(desired, &contact, Law::Report).into(), &theta);
    assert!((report - Vector3::new(3.0, 0.0, 0.0)).amax() < 1e-12, "{report}");
    // The rotation vector of a turn about y by 0.3 rad is 0.3 y, whatever the angles of the other joints.
    let exact = law().spring(&set_point(desired, &contact, Law::Exact).into(), &theta);
    assert!((exact - report).amax() < 1e-12, "{exact}");
}

/// A frictionless point exerts no force across its normal.
#[test]
fn a_frictionless_point_slides() {
    let theta = Vector3::new(0.2, 0.5, 1.0);
    let normal = Vector3::new(1.0, -2.0, 0.5).normalize();
    let contact = Contact::frictionless_point(4.0, normal).expect("a spring");
    let across = normal.cross(&Vector3::z());
    let wrench = contact.stiffness() * Vector6::new(across.x, across.y, across.z, 0.3, 0.4, 0.5);
    assert!(wrench.amax() < 1e-12);
    let eigenvalues =
        law().joint_stiffness(&set_point(theta, &contact, Law::Report).into(), &theta).symmetric_eigenvalues();
    assert_eq!(eigenvalues.iter().filter(|&&value| value.abs() > 1e-9).count(), 1);
}

/// The torque of a soft finger keeps its direction when the finger is turned away by more than half a turn. A soft
/// finger resists the rotation about the normal, which is parallel to the axes of joints 1 and 2 here.
#[test]
fn beyond_half_a_turn_the_torque_of_a_soft_finger_keeps_its_direction() {
    let theta = Vector3::new(0.0, -0.5, 0.1);
    let contact = Contact::soft_finger(Matrix4::from_diagonal_element(1.0), Vector3::x()).expect("a spring");
    let mut last = 0.0;
    for step in 1..=40 {
        let turned = theta + Vector3::new(0.0, f64::from(step) * 0.05, f64::from(step) * 0.05);
        let vector = LINKS.rotation_between(&theta, &turned);
        assert!((vector - Vector3::x() * f64::from(step) * 0.1).amax() < 1e-12, "{step}: {vector}");
        // The translation acts too, so two springs are compared: one has a rotational stiffness, one has none.
        let mut k = Matrix4::from_diagonal_element(1.0);
        k[(3, 3)] = 0.0;
        let without = Contact::soft_finger(k, Vector3::x()).expect("a spring");
        let torque = |contact: &Contact| law().spring(&set_point(turned, contact, Law::Exact).into(), &theta);
        let rotational = torque(&contact)[1] - torque(&without)[1];
        assert!(rotational > last, "{step}: {rotational} after {last}");
        last = rotational;
    }
}
