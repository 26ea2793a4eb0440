//! Tests equations 5, 8, 18-20 and the upper bound of the tensions against their definitions and against a search.

use nalgebra::{Matrix3x4, RowVector4, Vector3, Vector4};
use proptest::prelude::*;
use sun2xp::control::{Controller, JointStiffness, Law, SetPoint, TensionDistribution};
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::model::{Links, Tendons, TendonsError};

const MINIMUM: f64 = 5.0;
const MAXIMUM: f64 = 60.0;

fn tendons(ghost: Option<[f64; 4]>) -> Tendons {
    let mut finger = ConfiguredFinger::default();
    finger.geometry.ghost_row = ghost;
    finger.tendons().unwrap()
}

/// Eq. 20 written directly from its definition, without an upper bound.
fn least(tendons: &Tendons, torque: Vector3<f64>) -> Vector4<f64> {
    let q = tendons.q;
    let pulled = q.fixed_columns::<3>(0) * torque;
    let ghost = (0..4).map(|i| (MINIMUM - pulled[i]) / q[(i, 3)]).fold(f64::NEG_INFINITY, f64::max);
    pulled + q.column(3) * ghost
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: ProptestConfig::default().cases.max(2000),
        failure_persistence: None,
        ..Default::default()
    })]

    #[test]
    fn tensions_give_the_scaled_torque_within_both_bounds_with_the_largest_scale(
        direction in prop::array::uniform3(-1.0..1.0f64), size in 0.0..300.0f64,
        ghost in prop::option::of(prop::array::uniform4(0.2..3.0f64)),
        limits in prop::array::uniform4(0.0..80.0f64),
    ) {
        let tendons = tendons(ghost);
        let torque = Vector3::from(direction) * size;
        let distribution = TensionDistribution::new(&tendons, MINIMUM, Vector4::repeat(MAXIMUM)).unwrap();
        let found = distribution.below(&limits.into()).distribute(&torque);
        // The bound of a tendon is never below its pretension. So if a motor is too weak for the pretension, the bound
        // of its tendon is the pretension.
        let bounds = Vector4::from(limits).inf(&Vector4::repeat(MAXIMUM)).sup(&tendons.pretension(MINIMUM));
        let within = |tensions: &Vector4<f64>, tolerance: f64| (tensions - bounds).max() <= tolerance;
        prop_assert!((tendons.r * found.tensions - torque * found.scale).amax() < 1e-9 * (1.0 + size));
        prop_assert!(found.tensions.min() >= MINIMUM);
        prop_assert!(within(&found.tensions, 1e-9), "{} beyond {bounds}", found.tensions);
        prop_assert!((0.0..=1.0).contains(&found.scale));
        // The least tensions are convex functions of the scale, and are within the bounds at a scale of 0. So they are
        // within the bounds at every scale up to the largest one, and bisection finds it.
        let largest = |tolerance: f64| {
            let fits = |scale: f64| within(&least(&tendons, torque * scale), tolerance);
            let (mut low, mut high) = (0.0, 1.0);
            if fits(1.0) {
                return 1.0;
            }
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if fits(middle) { low = middle } else { high = middle }
            }
            low
        };
        // A tension is a sum of four products of at most 300 N, each with a relative rounding error of 1e-16. If a
        // tension hardly depends on the scale, these errors change the largest scale a lot. So the tolerance applies to
        // the tensions: the search with lower and with higher bounds of the tensions gives a range of scales.
        let rounding = 1e-14 * (100.0 + size);
        let (lowest, highest) = (largest(-rounding), largest(rounding));
        // The bisection itself ends with an interval of 1e-18.
        let scale = found.scale;
        prop_assert!((lowest - 1e-15..=highest + 1e-15).contains(&scale), "{scale}, not {lowest} to {highest}");
    }

    /// All other tensions that give the same torque are larger in the 1-, 2- and infinity-norm: R's null vector is all
    /// positive, so any other choice above t_min adds a positive multiple of it.
    #[test]
    fn tensions_are_the_least(direction in prop::array::uniform3(-1.0..1.0f64), more in 1e-6..10.0f64) {
        let tendons = tendons(None);
        let torque = Vector3::from(direction) * 20.0;
        let distribution = TensionDistribution::new(&tendons, MINIMUM, Vector4::repeat(MAXIMUM)).unwrap();
        let tensions = distribution.distribute(&torque).tensions;
        let home = tendons.pretension(1.0);
        prop_assert!((tendons.r * home).amax() < 1e-12 && home.min() > 0.0);
        prop_assert!((tensions - home * more).min() < MINIMUM);
        let other = tensions + home * more;
        prop_assert!(tensions.sum() < other.sum() && tensions.norm() < other.norm() && tensions.max() < other.max());
    }

    #[test]
    fn tensions_do_not_depend_on_the_ghost_row(
        direction in prop::array::uniform3(-60.0..60.0f64), ghost in prop::array::uniform4(0.2..3.0f64),
    ) {
        let torque = Vector3::from(direction);
        let by = |ghost| {
            let maximum = Vector4::repeat(MAXIMUM);
            TensionDistribution::new(&tendons(ghost), MINIMUM, maximum).unwrap().distribute(&torque)
        };
        let (with, without) = (by(Some(ghost)), by(None));
        prop_assert!((with.tensions - without.tensions).amax() < 1e-9);
        prop_assert!((with.scale - without.scale).abs() < 1e-9);
    }

    #[test]
    fn jacobian_is_the_derivative_of_the_tip(theta in prop::array::uniform3(-2.0..2.0f64)) {
        let links = Links([3.556, 5.080, 4.000]);
        let theta = Vector3::from(theta);
        let jacobian = links.jacobian(&theta);
        for joint in 0..3 {
            let mut step = Vector3::zeros();
            step[joint] = 1e-5;
            let difference = (links.tip(&(theta + step)) - links.tip(&(theta - step))) / 2e-5;
            prop_assert!((jacobian.column(joint) - difference).amax() < 1e-8);
        }
    }

    /// At rest there is no damping, and the work of the joint torques equals the work of a tip spring, eq. 5, also for
    /// a Kx that couples directions. In motion, the damper feeds no power into the finger.
    #[test]
    fn joint_torques_are_those_of_the_tip_spring(
        theta in prop::array::uniform3(-1.0..1.0f64), away in prop::array::uniform3(-0.2..0.2f64),
        rates in prop::array::uniform3(-3.0..3.0f64), root in prop::array::uniform9(-1.5..1.5f64),
    ) {
        let links = Links([3.556, 5.080, 4.000]);
        let (theta, away, rates) = (Vector3::from(theta), Vector3::from(away), Vector3::from(rates));
        let root = nalgebra::Matrix3::from_row_slice(&root);
        let hard_finger = SetPoint::hard_finger(theta + away, root * root.transpose());
        let set_point = SetPoint { law: Law::Report, ..hard_finger };
        let law = JointStiffness::new(links, 0.02);
        let jacobian = links.jacobian(&theta);
        let expected = jacobian.transpose() * (root * root.transpose() * (jacobian * away));
        let rest = law.torques(&set_point.into(), &theta, &Vector3::zeros());
        prop_assert!((rest - expected).amax() < 1e-9);
        let power = rates.dot(&(law.torques(&set_point.into(), &theta, &rates) - rest));
        prop_assert!(power <= 1e-9, "the damper fed {power} into the finger");
    }
}

#[test]
fn without_stiffness_only_damping_is_left() {
    let set_point = SetPoint::hard_finger(Vector3::new(0.3, 0.2, 0.1), nalgebra::Matrix3::zeros());
    let law = JointStiffness::new(Links([3.556, 5.080, 4.000]), 0.02);
    assert_eq!(law.torques(&set_point.into(), &Vector3::zeros(), &Vector3::zeros()), Vector3::zeros());
    let rates = Vector3::new(1.0, -2.0, 0.5);
    assert!(law.torques(&set_point.into(), &Vector3::zeros(), &rates).angle(&-rates) < 1e-6);
}

/// Section 5.5 of the report prints +1.09 for entry (2, 4) of R. With this value and the printed ghost row the matrix
/// is singular. With any other ghost row, the tendons cannot all pull while the joints are at rest.
#[test]
fn printed_r_is_refused() {
    for ghost in [None, Some([1.0; 4])] {
        let mut finger = ConfiguredFinger::default();
        finger.geometry.ghost_row = ghost;
        assert!(Controller::new(&finger, 1000.0).is_ok());
        finger.geometry.r[1][3] = 1.09;
        let refusal = Controller::new(&finger, 1000.0).unwrap_err();
        assert_eq!(refusal.key, "geometry.r");
        let named = if ghost.is_some() { "singular" } else { "ghost column" };
        assert!(refusal.reason.contains(named), "{}", refusal.reason);
    }
}

#[test]
fn bounds_that_leave_no_pretension_are_refused() {
    // R's null vector is (0.62, 1.09, 1.09, 0.62), so t_max must exceed 1.758 t_min.
    let tendons = tendons(None);
    assert!(TensionDistribution::new(&tendons, 5.0, Vector4::repeat(8.8)).is_ok());
    let refusal = TensionDistribution::new(&tendons, 5.0, Vector4::repeat(8.7)).unwrap_err();
    assert_eq!(refusal.key, "tendon.maximum");
    assert!(refusal.reason.contains("8.79"), "{}", refusal.reason);
}

#[test]
fn tendons_that_cannot_hold_are_refused() {
    let r = Matrix3x4::new(1.0, 0.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0);
    let refusal = Tendons::new(r, Vector4::repeat(0.0475), Some(RowVector4::repeat(1.0)));
    assert!(matches!(refusal, Err(TendonsError::GhostColumn(_))));
}
