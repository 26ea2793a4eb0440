//! What a planner may ask of a finger: the checks between a call and the servo. Nothing that fails one reaches it.

use crate::hand::SetPointError;
use crate::hand::damping_admission::DampingAdmission;
use crate::model::InverseKinematics;
use crate::model::configuration::{Law, OutOfRange};
use crate::model::{Contact, ContactError, Links, spring};
use nalgebra::{Matrix3, Matrix3x4, Matrix6, Vector3};

/// The limits of one finger, and what its tip is computed with.
#[derive(Clone, Debug)]
pub(super) struct Admission {
    /// 1 to 3.
    pub finger: i32,
    /// Lower and upper joint limits, rad.
    pub joint_limits: (Vector3<f64>, Vector3<f64>),
    /// Bound on the largest eigenvalue of Kx, N/cm.
    pub stiffness_bound: f64,
    /// A^-1 within the joint limits.
    pub inverse_kinematics: InverseKinematics,
    pub links: Links,
    /// R of eq. 14, cm.
    pub r: Matrix3x4<f64>,
    /// The damping that goes with a stiffness.
    pub damping: DampingAdmission,
    /// What SendPos makes of deflections.
    pub law: Law,
    /// Refuse or clamp.
    pub out_of_range: OutOfRange,
}

impl Admission {
    /// Desired joint angles, rad, as they may be sent to the servo.
    pub fn joints(&self, joints: [f64; 3]) -> Result<Vector3<f64>, SetPointError> {
        self.finite("Pos", &joints)?;
        let mut admitted = Vector3::from(joints);
        for joint in 0..3 {
            let (low, high) = (self.joint_limits.0[joint], self.joint_limits.1[joint]);
            // A limit sent as `float` is a limit: it may be rounded beyond it.
            let rounding = f64::from(f32::EPSILON) * low.abs().max(high.abs());
            let value = joints[joint];
            if (value < low - rounding || value > high + rounding) && self.out_of_range == OutOfRange::Refuse {
                return Err(SetPointError::BeyondJointLimit { finger: self.finger, joint, value, low, high });
            }
            admitted[joint] = value.clamp(low, high);
        }
        Ok(admitted)
    }

    /// Kx, N/cm, symmetric, positive semi-definite and within the bound. `rows[row][column]`.
    pub fn stiffness(&self, rows: [[f64; 3]; 3]) -> Result<Matrix3<f64>, SetPointError> {
        // nalgebra is column-major: this is the one place where the order of C is turned.
        let asked = Matrix3::from_fn(|row, column| rows[row][column]);
        let (symmetric, (smallest, largest)) = spring(&asked).map_err(|error| self.no_spring(error))?;
        let bound = self.stiffness_bound;
        // A bound sent as `float` is a bound.
        let too_stiff = largest > bound * (1.0 + 8.0 * f64::from(f32::EPSILON));
        if too_stiff && self.out_of_range == OutOfRange::Refuse {
            return Err(SetPointError::TooStiff { finger: self.finger, largest, bound });
        }
        if !too_stiff && smallest >= 0.0 {
            return Ok(symmetric);
        }
        // The nearest admissible spring keeps its principal directions.
        let mut eigen = symmetric.symmetric_eigen();
        eigen.eigenvalues.apply(|eigenvalue| *eigenvalue = eigenvalue.clamp(0.0, bound));
        let recomposed = eigen.recompose();
        Ok((recomposed + recomposed.transpose()) * 0.5)
    }

    /// Why a Kx is no spring.
    fn no_spring(&self, error: ContactError) -> SetPointError {
        let finger = self.finger;
        match error {
            ContactError::NotFinite(value) => SetPointError::NotFinite { what: "Kx", finger, value },
            ContactError::NotSymmetric { row, column, difference } => {
                SetPointError::NotSymmetric { finger, row, column, difference }
            }
            ContactError::Negative { smallest } => SetPointError::Negative { finger, smallest },
            ContactError::NoNormal => SetPointError::Contact { finger, source: error },
        }
    }

    /// Joint angles, rad, for a tip position, cm, nearest to the `present` ones. Never clamped: the nearest point of
    /// the workspace may be on the other side of an object.
    pub fn tip(&self, tip: [f64; 3], present: &Vector3<f64>) -> Result<Vector3<f64>, SetPointError> {
        self.finite("Tip", &tip)?;
        let found = self.inverse_kinematics.joints(&Vector3::from(tip), present);
        found.map_err(|source| SetPointError::OutOfReach { finger: self.finger, tip, source })
    }

    /// The stiffness of a contact, within the bound. A rotation counts by the way it moves the last joint.
    pub fn contact(&self, contact: &Contact) -> Result<Matrix6<f64>, SetPointError> {
        let (bound, lever) = (self.stiffness_bound, self.links.0[2]);
        let largest = contact.largest_eigenvalue(lever);
        // A bound sent as `float` is a bound.
        if largest <= bound * (1.0 + 8.0 * f64::from(f32::EPSILON)) {
            return Ok(*contact.stiffness());
        }
        match self.out_of_range {
            OutOfRange::Refuse => Err(SetPointError::TooStiff { finger: self.finger, largest, bound }),
            OutOfRange::Clamp => Ok(*contact.clamped(bound, lever).stiffness()),
        }
    }

    /// Refuses NaN and infinity: they must never reach the servo.
    pub fn finite(&self, what: &'static str, values: &[f64]) -> Result<(), SetPointError> {
        match values.iter().find(|value| !value.is_finite()) {
            None => Ok(()),
            Some(&value) => Err(SetPointError::NotFinite { what, finger: self.finger, value }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::AdmissibleDamping;
    use crate::model::configuration::ConfiguredFinger;
    use proptest::prelude::*;

    fn admission(out_of_range: OutOfRange) -> Admission {
        let joint_limits = (Vector3::new(-1.0, -0.5, 0.1), Vector3::new(1.0, 1.7, 2.0));
        let links = Links([3.556, 5.080, 4.000]);
        Admission {
            finger: 2,
            joint_limits,
            inverse_kinematics: InverseKinematics::new(links, joint_limits),
            links,
            r: Matrix3x4::zeros(),
            stiffness_bound: 6.0,
            damping: DampingAdmission {
                finger: 2,
                admissible: AdmissibleDamping::new(&ConfiguredFinger::default(), 1000.0),
                lever: 4.0,
                out_of_range,
            },
            law: Law::Report,
            out_of_range,
        }
    }

    #[test]
    fn kx_is_taken_row_by_row() {
        let rows = [[3.0, 0.5, 0.001], [0.5, 2.0, 0.25], [0.0, 0.25, 1.0]];
        let kx = admission(OutOfRange::Refuse).stiffness(rows).expect("admissible");
        assert_eq!(kx[(0, 1)], 0.5);
        assert_eq!(kx[(1, 2)], 0.25);
        // Less than a thousandth of the largest entry: symmetrised.
        assert_eq!(kx[(0, 2)], 0.0005);
        assert_eq!(kx, kx.transpose());
        let skewed = [[3.0, 0.5, 0.004], [0.5, 2.0, 0.25], [0.0, 0.25, 1.0]];
        let refused = admission(OutOfRange::Refuse).stiffness(skewed);
        assert!(matches!(refused, Err(SetPointError::NotSymmetric { row: 0, column: 2, .. })), "{refused:?}");
    }

    #[test]
    fn springs_of_any_rank_are_admitted_and_others_refused() {
        let diagonal = |a, b, c| [[a, 0.0, 0.0], [0.0, b, 0.0], [0.0, 0.0, c]];
        let refuse = admission(OutOfRange::Refuse);
        for rows in [diagonal(0.0, 0.0, 0.0), diagonal(6.0, 0.0, 1.0), diagonal(6.0, 6.0, 6.0)] {
            assert!(refuse.stiffness(rows).is_ok(), "{rows:?}");
        }
        assert!(matches!(refuse.stiffness(diagonal(6.1, 0.0, 0.0)), Err(SetPointError::TooStiff { .. })));
        assert!(matches!(refuse.stiffness(diagonal(1.0, -0.1, 0.0)), Err(SetPointError::Negative { .. })));
        assert!(matches!(refuse.stiffness(diagonal(-1.0, 0.0, 0.0)), Err(SetPointError::Negative { .. })));
        assert!(matches!(refuse.stiffness(diagonal(f64::NAN, 0.0, 0.0)), Err(SetPointError::NotFinite { .. })));
        // Within rounding of zero: taken as zero.
        let kx = refuse.stiffness(diagonal(1.0, -0.0005, 0.0)).expect("admissible");
        assert!(kx.symmetric_eigenvalues().min() > -1e-12);
    }

    #[test]
    fn no_finite_kx_becomes_nan() {
        let (huge, tiny) = (f64::MAX, f64::MIN_POSITIVE / 1024.0);
        for value in [huge, 0.9 * huge, 1e200, tiny] {
            for rows in [[[value; 3]; 3], [[value, 0.0, 0.0], [0.0, value, 0.0], [0.0, 0.0, 0.0]]] {
                let clamped = admission(OutOfRange::Clamp).stiffness(rows).expect("clamped");
                assert!(clamped.iter().all(|entry| entry.is_finite()), "{value:e}: {clamped}");
                let refused = admission(OutOfRange::Refuse).stiffness(rows);
                assert_eq!(refused.is_err(), value > 1.0, "{value:e}: {refused:?}");
                let negative = admission(OutOfRange::Clamp).stiffness(rows.map(|row| row.map(|entry| -entry)));
                assert!(matches!(negative, Err(SetPointError::Negative { .. })), "-{value:e}: {negative:?}");
            }
        }
    }

    #[test]
    fn clamping_takes_the_nearest_admissible_value() {
        let clamp = admission(OutOfRange::Clamp);
        assert_eq!(clamp.joints([2.0, -3.0, 1.0]).expect("clamped"), Vector3::new(1.0, -0.5, 1.0));
        let kx = clamp.stiffness([[5.0, 4.0, 0.0], [4.0, 5.0, 0.0], [0.0, 0.0, 2.0]]).expect("clamped");
        // Eigenvalues 9 and 1 along the diagonals become 6 and 1.
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
        // 6 N/cm at 4 cm.
        let (refuse, clamp) = (admission(OutOfRange::Refuse), admission(OutOfRange::Clamp));
        assert_eq!(refuse.contact(&contact(96.0)).expect("admissible"), *contact(96.0).stiffness());
        assert!(matches!(refuse.contact(&contact(97.0)), Err(SetPointError::TooStiff { .. })));
        let clamped = clamp.contact(&contact(970.0)).expect("clamped");
        assert!((clamped - contact(96.0).stiffness()).amax() < 1e-10, "{clamped}");
    }

    #[test]
    fn a_limit_rounded_to_float_is_within_the_limit() {
        let mut refuse = admission(OutOfRange::Refuse);
        refuse.joint_limits.1[2] = 120f64.to_radians();
        let sent = f64::from(120f32.to_radians());
        assert!(sent > refuse.joint_limits.1[2], "the case must be one of rounding up");
        assert_eq!(refuse.joints([0.0, 0.0, sent]).expect("admitted")[2], refuse.joint_limits.1[2]);
        assert!(matches!(
            refuse.joints([0.0, 0.0, sent + 1e-3]),
            Err(SetPointError::BeyondJointLimit { joint: 2, .. })
        ));
    }
    proptest! {
        #![proptest_config(ProptestConfig {
            cases: ProptestConfig::default().cases.max(20_000),
            failure_persistence: None,
            ..Default::default()
        })]

        #[test]
        fn whatever_is_asked_what_is_admitted_is_a_spring_within_the_bound(
            mantissas in prop::array::uniform6(-1.0f64..1.0), exponents in prop::array::uniform6(-320i32..308),
        ) {
            let [a, b, c, d, e, f] = std::array::from_fn(|i| mantissas[i] * 10f64.powi(exponents[i]));
            for out_of_range in [OutOfRange::Clamp, OutOfRange::Refuse] {
                let Ok(kx) = admission(out_of_range).stiffness([[a, b, c], [b, d, e], [c, e, f]]) else { continue };
                prop_assert_eq!(kx, kx.transpose());
                let eigenvalues = kx.symmetric_eigenvalues();
                let within = |&value: &f64| (-1e-9..=6.0 * (1.0 + 1e-6)).contains(&value);
                prop_assert!(eigenvalues.iter().all(within), "{kx}{eigenvalues}");
            }
        }

        #[test]
        fn whatever_contact_is_asked_what_is_admitted_is_within_the_bound(
            mantissas in prop::array::uniform32(-1.0f64..1.0), exponents in prop::array::uniform6(-160i32..155),
            diagonal in prop::bool::ANY, lever in -1.0f64..2.0,
        ) {
            // A A^T of rank 5: a spring, but for rounding, of any size in each of its directions.
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
                Err(SetPointError::TooStiff { largest, bound: 6.0, .. }) => {
                    assert!(largest > 9e4 && largest.is_finite())
                }
                other => panic!("{torsion:e}: {other:?}"),
            }
            let clamped = clamp.contact(&contact).expect("clamped");
            let admitted = Contact::general(&clamped, &Matrix6::identity()).expect("a spring").largest_eigenvalue(0.1);
            assert!((admitted - 6.0).abs() < 1e-9, "{torsion:e}: {admitted} N/cm in {clamped}");
        }
    }
}
