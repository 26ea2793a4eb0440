//! Tests of the admission of joint angles, stiffnesses, contacts, damping, joint springs and joint torques.

use super::*;
use crate::control::Controller;
use crate::model::FingerNumber;
use crate::model::configuration::ConfiguredFinger;
use proptest::prelude::*;

fn admission(out_of_range: OutOfRange) -> Admission {
    let joint_limits = (Vector3::new(-1.0, -0.5, 0.1), Vector3::new(1.0, 1.7, 2.0));
    let links = Links([3.556, 5.080, 4.000]);
    Admission {
        finger: FingerNumber::TWO,
        joint_limits,
        inverse_kinematics: InverseKinematics::new(links, joint_limits),
        links,
        r: Matrix3x4::zeros(),
        springs: None,
        distribution: Controller::new(&ConfiguredFinger::default(), 1000.0).ok().map(|it| it.distribution().clone()),
        stiffness_bound: 6.0,
        damping: DampingAdmission {
            finger: FingerNumber::TWO,
            admissible: AdmissibleDamping::new(&ConfiguredFinger::default(), 1000.0),
            lever: 4.0,
            out_of_range,
        },
        law: Law::default(),
        motion_limits: crate::hand::MotionLimits([5.0, 100.0, 5000.0]),
        out_of_range,
    }
}

#[test]
fn kx_is_taken_row_by_row() {
    let rows = [[3.0, 0.5, 0.001], [0.5, 2.0, 0.25], [0.0, 0.25, 1.0]];
    let kx = admission(OutOfRange::Refuse).kx(rows).expect("admissible");
    assert_eq!(kx[(0, 1)], 0.5);
    assert_eq!(kx[(1, 2)], 0.25);
    // An asymmetry below a thousandth of the largest entry is removed.
    assert_eq!(kx[(0, 2)], 0.0005);
    assert_eq!(kx, kx.transpose());
    let skewed = [[3.0, 0.5, 0.004], [0.5, 2.0, 0.25], [0.0, 0.25, 1.0]];
    let refused = admission(OutOfRange::Refuse).kx(skewed);
    assert!(matches!(refused, Err(SetPointError::NotSymmetric { row: 0, column: 2, .. })), "{refused:?}");
}

#[test]
fn springs_of_any_rank_are_admitted_up_to_the_bound_and_other_matrices_are_refused() {
    let diagonal = |a, b, c| [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]];
    let refuse = admission(OutOfRange::Refuse);
    for rows in [diagonal(0.0, 0.0, 0.0), diagonal(6.0, 0.0, 1.0), diagonal(6.0, 6.0, 6.0)] {
        assert!(refuse.kx(rows).is_ok(), "{rows:?}");
    }
    assert!(matches!(refuse.kx(diagonal(6.1, 0.0, 0.0)), Err(SetPointError::TooStiff { .. })));
    assert!(matches!(refuse.kx(diagonal(1.0, -0.1, 0.0)), Err(SetPointError::Negative { .. })));
    assert!(matches!(refuse.kx(diagonal(-1.0, 0.0, 0.0)), Err(SetPointError::Negative { .. })));
    assert!(matches!(refuse.kx(diagonal(f64::NAN, 0.0, 0.0)), Err(SetPointError::NotFinite { .. })));
    // A negative eigenvalue counts as zero if its magnitude is at most a thousandth of the largest eigenvalue.
    let kx = refuse.kx(diagonal(1.0, -0.0005, 0.0)).expect("admissible");
    assert!(kx.symmetric_eigenvalues().min() > -1e-12);
}

#[test]
fn no_finite_kx_becomes_nan() {
    let (huge, tiny) = (f64::MAX, f64::MIN_POSITIVE / 1024.0);
    for value in [huge, 0.9 * huge, 1e200, tiny] {
        for rows in [[[value; 3]; 3], [[value, 0.0, 0.0], [0.0, value, 0.0], [0.0, 0.0, 0.0]]] {
            let clamped = admission(OutOfRange::Clamp).kx(rows).expect("clamped");
            assert!(clamped.iter().all(|entry| entry.is_finite()), "{value:e}: {clamped}");
            let refused = admission(OutOfRange::Refuse).kx(rows);
            assert_eq!(refused.is_err(), value > 1.0, "{value:e}: {refused:?}");
            let negative = admission(OutOfRange::Clamp).kx(rows.map(|row| row.map(|entry| -entry)));
            assert!(matches!(negative, Err(SetPointError::Negative { .. })), "-{value:e}: {negative:?}");
        }
    }
}

#[test]
fn clamping_takes_the_nearest_admissible_value() {
    let clamp = admission(OutOfRange::Clamp);
    assert_eq!(clamp.joints([2.0, -3.0, 1.0]).expect("clamped"), Vector3::new(1.0, -0.5, 1.0));
    let kx = clamp.kx([[5.0, 4.0, 0.0], [4.0, 5.0, 0.0], [0.0, 0.0, 2.0]]).expect("clamped");
    // The eigenvalues 9 in the direction (1, 1, 0) and 1 in the direction (1, -1, 0) become 6 and 1.
    let expected = Matrix3::new(3.5, 2.5, 0.0, 2.5, 3.5, 0.0, 0.0, 0.0, 2.0);
    assert!((kx - expected).amax() < 1e-12, "{kx}");
    assert!(matches!(clamp.joints([f64::INFINITY, 0.0, 1.0]), Err(SetPointError::NotFinite { .. })));
}

#[test]
fn a_torsion_counts_by_the_lever_of_the_last_link() {
    let contact = |torsion| {
        let k = nalgebra::Matrix4::from_diagonal(&nalgebra::Vector4::new(3.0, 3.0, 3.0, torsion));
        Contact::soft_finger(k, Vector3::z()).expect("a spring")
    };
    // 96 N cm/rad at 4 cm correspond to 6 N/cm.
    let (refuse, clamp) = (admission(OutOfRange::Refuse), admission(OutOfRange::Clamp));
    assert_eq!(refuse.contact(&contact(96.0)).expect("admissible"), *contact(96.0).stiffness());
    let refused = refuse.contact(&contact(97.0)).expect_err("too stiff");
    assert!(matches!(refused, SetPointError::TooStiffContact { .. }) && refused.to_string().contains("softer contact"));
    let clamped = clamp.contact(&contact(970.0)).expect("clamped");
    assert!((clamped - contact(96.0).stiffness()).amax() < 1e-10, "{clamped}");
}

#[test]
fn a_limit_rounded_to_float_is_within_the_limit() {
    let mut refuse = admission(OutOfRange::Refuse);
    refuse.joint_limits.1[2] = 120f64.to_radians();
    let sent = f64::from(120f32.to_radians());
    assert!(sent > refuse.joint_limits.1[2], "the test needs a limit that is rounded up");
    assert_eq!(refuse.joints([0.0, 0.0, sent]).expect("admitted")[2], refuse.joint_limits.1[2]);
    assert!(matches!(refuse.joints([0.0, 0.0, sent + 1e-3]), Err(SetPointError::BeyondJointLimit { joint: 2, .. })));
}
proptest! {
    #![proptest_config(ProptestConfig {
        cases: ProptestConfig::default().cases.max(20_000),
        failure_persistence: None,
        ..Default::default()
    })]

    #[test]
    fn every_admitted_kx_is_a_spring_within_the_bound(
        mantissas in prop::array::uniform6(-1.0f64..1.0), exponents in prop::array::uniform6(-320i32..308),
    ) {
        let [a, b, c, d, e, f] = std::array::from_fn(|i| mantissas[i] * 10f64.powi(exponents[i]));
        for out_of_range in [OutOfRange::Clamp, OutOfRange::Refuse] {
            let Ok(kx) = admission(out_of_range).kx([[a, b, c], [b, d, e], [c, e, f]]) else { continue };
            prop_assert_eq!(kx, kx.transpose());
            let eigenvalues = kx.symmetric_eigenvalues();
            let within = |&value: &f64| (-1e-9..=6.0 * (1.0 + 1e-6)).contains(&value);
            prop_assert!(eigenvalues.iter().all(within), "{kx}{eigenvalues}");
        }
    }

    #[test]
    fn every_admitted_contact_is_within_the_bound(
        mantissas in prop::array::uniform32(-1.0f64..1.0), exponents in prop::array::uniform6(-160i32..155),
        diagonal in prop::bool::ANY, lever in -1.0f64..2.0,
    ) {
        // The product of `root` and its transpose has rank 5 and is a spring, except for rounding. The magnitude of the
        // product in each direction is arbitrary.
        let root = nalgebra::SMatrix::<f64, 6, 5>::from_fn(|row, column| match diagonal && row != column {
            true => 0.0,
            false => mantissas[5 * row + column] * 10f64.powi(exponents[row]),
        });
        let lever = 10f64.powf(lever);
        for out_of_range in [OutOfRange::Clamp, OutOfRange::Refuse] {
            let mut admission = admission(out_of_range);
            admission.links.0[2] = lever;
            let Ok(contact) = Contact::general(&(root * root.transpose()), &Matrix6::identity()) else { continue };
            let Ok(admitted) = admission.contact(&contact) else { continue };
            let admitted = Contact::general(&admitted, &Matrix6::identity());
            prop_assert!(admitted.is_ok(), "{admitted:?}");
            let largest = admitted.unwrap().largest_eigenvalue(lever);
            prop_assert!(largest <= 6.0 * (1.0 + 1e-6), "{largest} with a lever of {lever} cm");
        }
    }
}

#[test]
fn a_torsion_at_a_short_link_is_too_stiff_however_large() {
    for torsion in [1e3, 1e306, f64::MAX] {
        let k = nalgebra::Matrix4::from_diagonal(&nalgebra::Vector4::new(3.0, 3.0, 3.0, torsion));
        let contact = Contact::soft_finger(k, Vector3::new(0.3, -0.5, 0.8)).expect("a spring");
        let (mut refuse, mut clamp) = (admission(OutOfRange::Refuse), admission(OutOfRange::Clamp));
        (refuse.links.0[2], clamp.links.0[2]) = (0.1, 0.1);
        match refuse.contact(&contact) {
            Err(SetPointError::TooStiffContact { largest, bound: 6.0, .. }) => {
                assert!(largest > 9e4 && largest.is_finite())
            }
            other => panic!("{torsion:e}: {other:?}"),
        }
        let clamped = clamp.contact(&contact).expect("clamped");
        let admitted = Contact::general(&clamped, &Matrix6::identity()).expect("a spring").largest_eigenvalue(0.1);
        assert!((admitted - 6.0).abs() < 1e-9, "{torsion:e}: {admitted} N/cm in {clamped}");
    }
}

mod damping {
    use super::*;

    fn set_point(stiffness: f64, damping: f64) -> SetPoint {
        SetPoint { damping, ..SetPoint::hard_finger(Vector3::zeros(), Matrix3::identity() * stiffness) }
    }

    fn admission(out_of_range: OutOfRange) -> DampingAdmission {
        let admissible = AdmissibleDamping::new(&ConfiguredFinger::default(), 1000.0);
        DampingAdmission { finger: FingerNumber::TWO, admissible, lever: 4.0, out_of_range }
    }

    #[test]
    fn damping_that_would_oscillate_or_break_a_tendon_is_refused_with_the_range() {
        let refuse = admission(OutOfRange::Refuse);
        for (stiffness, damping) in
            [(3.0, 3.0), (6.0, 2.0), (6.0, 0.5), (3.0, 0.2), (6.0, 0.2), (3.0, 0.66), (6.0, 1.01)]
        {
            let refused = refuse.admit(&mut set_point(stiffness, damping)).expect_err("refused");
            let (least, most) = refuse.admissible.range(stiffness);
            let text = refused.to_string();
            assert!(text.contains(&format!("{least:.2} to {most:.2}")), "{text}");
        }
        for (stiffness, damping) in [(3.0, 0.67), (3.0, 1.53), (6.0, 0.94), (6.0, 1.0), (0.0, 0.4), (11.0, 1.0)] {
            let mut admitted = set_point(stiffness, damping);
            refuse.admit(&mut admitted).expect("admitted");
            assert_eq!(admitted, set_point(stiffness, damping));
            // 0.94, rounded to float, is just below the lower limit 0.94, and is admitted as this limit.
            let mut rounded = set_point(stiffness, f64::from(damping as f32));
            refuse.admit(&mut rounded).expect("admitted");
            assert!((rounded.damping - damping).abs() < 1e-7 && rounded.damping >= least_of(&refuse, stiffness));
        }
    }

    fn least_of(admission: &DampingAdmission, stiffness: f64) -> f64 {
        admission.admissible.range(stiffness).0
    }

    #[test]
    fn clamping_changes_the_damping_only() {
        for (stiffness, damping, clamped) in [(3.0, 0.0, 0.67), (6.0, 9.0, 1.0), (6.0, 1.0, 1.0)] {
            let mut admitted = set_point(stiffness, damping);
            admission(OutOfRange::Clamp).admit(&mut admitted).expect("clamped");
            assert_eq!(admitted, set_point(stiffness, clamped));
        }
    }

    #[test]
    fn a_torsion_counts_by_the_lever_of_the_last_link() {
        let mut torsion = set_point(0.0, 1.5);
        torsion.stiffness[(3, 3)] = 96.0; // 6 N/cm at 4 cm
        let refused = admission(OutOfRange::Refuse).admit(&mut torsion);
        assert!(
            matches!(refused, Err(SetPointError::Damping { stiffness, .. }) if (stiffness - 6.0).abs() < 1e-9),
            "{refused:?}"
        );
    }
}

#[test]
fn joint_springs_are_admitted_up_to_the_bound_and_torques_up_to_the_tensions() {
    let (refuse, clamp) = (admission(OutOfRange::Refuse), admission(OutOfRange::Clamp));
    let diagonal = |a, b, c| [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]];
    for rows in [diagonal(0.0, 0.0, 0.0), diagonal(50.0, 0.0, 10.0), [[60.0, 5.0, 0.0], [5.0, 60.0, 0.0], [0.0; 3]]] {
        assert!(refuse.k_theta(rows).is_ok(), "{rows:?}");
    }
    // 96 N cm/rad at a lever of 4 cm correspond to 6 N/cm.
    assert!(refuse.k_theta(diagonal(96.0, 96.0, 96.0)).is_ok());
    assert!(matches!(refuse.k_theta(diagonal(0.0, 1e300, 0.0)), Err(SetPointError::TooStiffJoints { .. })));
    for stiff in [96.1, 1e6] {
        let error = refuse.k_theta(diagonal(0.0, stiff, 0.0)).expect_err("too stiff, but admitted");
        assert!(matches!(error, SetPointError::TooStiffJoints { bound: 96.0, .. }), "{error}");
        let clamped = clamp.k_theta(diagonal(50.0, stiff, 0.0)).expect("clamped");
        assert!((clamped - Matrix3::from_diagonal(&Vector3::new(50.0, 96.0, 0.0))).amax() < 1e-6, "{clamped}");
    }
    assert!(matches!(refuse.k_theta(diagonal(1.0, -0.1, 0.0)), Err(SetPointError::JointStiffness { .. })));
    assert!(matches!(refuse.k_theta(diagonal(f64::NAN, 0.0, 0.0)), Err(SetPointError::NotFinite { .. })));

    let error = refuse.torque([0.0, 1e6, 0.0]).expect_err("too much torque, but admitted");
    let SetPointError::TooMuchTorque { least, most, .. } = error else { panic!("{error}") };
    for joint in 0..3 {
        for limit in [least[joint], most[joint]] {
            let mut torque = [0.0; 3];
            torque[joint] = limit;
            assert!(refuse.torque(torque).is_ok() && limit.abs() > 1.0, "{torque:?}");
            torque[joint] = limit * 1.01;
            assert!(refuse.torque(torque).is_err(), "{torque:?}");
            let clamped = clamp.torque(torque).expect("clamped");
            assert!((clamped[joint] / limit - 1.0).abs() < 1e-9, "{clamped}");
        }
    }
    assert!(matches!(refuse.torque([f64::INFINITY, 0.0, 0.0]), Err(SetPointError::NotFinite { .. })));
}
