//! Tests of `Contact`: the 6 x 6 stiffness that follows from K and the selection, and the values that are refused.

use super::*;
use proptest::prelude::*;

proptest! {
    /// Lengths from almost the smallest to almost the largest double are tried.
    #[test]
    fn the_length_of_a_normal_does_not_matter(
        mantissa in 1.0..1.7f64, exponent in -300..=308i32,
        direction in proptest::array::uniform3(-1.0..1.0f64)
            .prop_filter("no direction", |d| d.iter().any(|x| x.abs() > 0.1)),
    ) {
        let unit = Vector3::from(direction).normalize();
        let long = unit * format!("{mantissa}e{exponent}").parse::<f64>().expect("a number");
        let soft = Matrix4::from_diagonal(&nalgebra::Vector4::new(3.0, 2.0, 1.0, 1e6));
        let (point, soft) = (
            |normal| Contact::frictionless_point(3.0, normal).expect("a spring"),
            |normal| Contact::soft_finger(soft, normal).expect("a spring"),
        );
        prop_assert!((point(long).stiffness() - point(unit).stiffness()).amax() < 1e-13);
        prop_assert!((soft(long).stiffness() - soft(unit).stiffness()).amax() < 1e-7);
    }

    /// K has an eigenvalue that is negative within the tolerance, and the rows of the selection differ in length.
    #[test]
    fn no_selection_makes_a_stiffness_negative(
        root in proptest::array::uniform9(-1.0..1.0f64), below in 0.0..1e-3f64, length in -2.0..2.0f64,
    ) {
        let axes = Matrix3::from_row_slice(&root).qr().q();
        let k = axes * Matrix3::from_diagonal(&Vector3::new(1.0, 0.5, -below)) * axes.transpose();
        let mut selection = translation();
        selection[(1, 1)] = 10f64.powf(length);
        let contact = Contact::general(&k, &selection).expect("a spring within the tolerance");
        let eigenvalues = contact.stiffness().symmetric_eigenvalues();
        prop_assert!(eigenvalues.min() >= -1e-9 * eigenvalues.max(), "{eigenvalues}");
        let mut k = k.fixed_resize::<4, 4>(0.0);
        k[(3, 3)] = 1.0;
        let soft = Contact::soft_finger(k, Vector3::y()).expect("a spring within the tolerance");
        let eigenvalues = soft.stiffness().symmetric_eigenvalues();
        prop_assert!(eigenvalues.min() >= -1e-9 * eigenvalues.max(), "{eigenvalues}");
    }
}

#[test]
fn a_rotational_stiffness_does_not_hide_a_negative_translational_one() {
    let k = Matrix4::from_diagonal(&nalgebra::Vector4::new(3.0, 3.0, -0.09, 96.0));
    let refused = Contact::soft_finger(k, Vector3::y());
    assert!(matches!(refused, Err(ContactError::Negative { smallest }) if smallest == -0.09), "{refused:?}");
}

#[test]
fn the_shortest_normal_has_a_direction() {
    for length in [5e-324, -5e-324, 1e-310, f64::MIN_POSITIVE, f64::MAX] {
        let point = Contact::frictionless_point(3.0, Vector3::new(0.0, length, 0.0)).expect("a spring");
        assert_eq!(point.stiffness()[(1, 1)], 3.0, "{length}");
    }
}

#[test]
fn contacts_transmit_the_directions_of_their_selections() {
    let kx = Matrix3::new(3.0, 0.5, 0.1, 0.5, 2.0, 0.25, 0.1, 0.25, 1.0);
    let hard = Contact::hard_finger(kx).expect("a spring");
    assert_eq!(hard.stiffness().fixed_view::<3, 3>(0, 0), kx);
    assert_eq!(hard.stiffness().fixed_view::<6, 3>(0, 3).amax(), 0.0);

    let normal = Vector3::new(0.0, 3.0, 4.0);
    let point = Contact::frictionless_point(2.0, normal).expect("a spring");
    let n = normal / 5.0;
    assert!((point.stiffness().fixed_view::<3, 3>(0, 0) - n * n.transpose() * 2.0).amax() < 1e-15);

    let mut k = Matrix4::identity() * 3.0;
    k[(3, 3)] = 20.0;
    (k[(0, 3)], k[(3, 0)]) = (0.5, 0.5);
    let soft = Contact::soft_finger(k, normal).expect("a spring");
    let turned = nalgebra::Vector6::new(0.0, 0.0, 0.0, 0.1, 0.6, 0.8);
    let wrench = soft.stiffness() * turned;
    // The tip is rotated by 1 rad about the normal, and by 0.1 rad about x. The normal is the only axis about which a
    // soft finger transmits a moment, so the rotation about x has no effect.
    let expected = nalgebra::Vector6::new(0.5, 0.0, 0.0, 0.0, 12.0, 16.0);
    assert!((wrench - expected).amax() < 1e-12, "{wrench}");
    assert!((soft.largest_eigenvalue(1.0) - 20.0147).abs() < 1e-3);
    assert!(soft.largest_eigenvalue(4.0) < 3.1);
    let clamped = soft.clamped(6.0, 1.0);
    assert!((clamped.largest_eigenvalue(1.0) - 6.0).abs() < 1e-12);
    assert!((soft.clamped(6.0, 4.0).stiffness() - soft.stiffness()).amax() < 1e-12);
}

#[test]
fn a_stiffness_that_is_not_a_spring_is_refused() {
    let skewed = Matrix3::new(3.0, 0.5, 0.0, 0.4, 2.0, 0.0, 0.0, 0.0, 1.0);
    assert!(matches!(Contact::hard_finger(skewed), Err(ContactError::NotSymmetric { row: 0, column: 1, .. })));
    assert!(matches!(Contact::frictionless_point(-1.0, Vector3::x()), Err(ContactError::Negative { .. })));
    assert!(matches!(Contact::frictionless_point(1.0, Vector3::zeros()), Err(ContactError::NoNormal)));
    assert!(matches!(Contact::frictionless_point(f64::NAN, Vector3::x()), Err(ContactError::NotFinite(_))));
    let infinite = Vector3::new(0.0, f64::INFINITY, 0.0);
    assert!(matches!(Contact::soft_finger(Matrix4::identity(), infinite), Err(ContactError::NotFinite(_))));
    let overflowing = SMatrix::<f64, 1, 6>::repeat(1e200);
    let refused = Contact::general(&SMatrix::<f64, 1, 1>::new(1.0), &overflowing);
    assert!(matches!(refused, Err(ContactError::NotFinite(_))));
    let huge = Contact::hard_finger(Matrix3::from_diagonal_element(f64::MAX)).expect("a spring");
    assert!(huge.stiffness().iter().all(|entry| entry.is_finite()));
    // A negative rotational stiffness is found although all translational stiffnesses are positive.
    let k = Matrix4::from_diagonal(&nalgebra::Vector4::new(3.0, 3.0, 3.0, -1.0));
    assert!(matches!(Contact::soft_finger(k, Vector3::x()), Err(ContactError::Negative { .. })));
}
