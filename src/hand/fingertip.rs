//! The state of a fingertip: position, force and tendon tensions.

use crate::finger::{FingerReport, Stage};
use crate::hand::admission::Admission;
use crate::hand::{Hand, HandError};
use crate::model::FingerNumber;
use nalgebra::Matrix3;

/// Limit of observability, cm per rad. If a joint motion of 1 rad moves the fingertip in a direction by less than this,
/// the force in that direction cannot be found from the joint torques: a torque error of 0.1 N cm would cause a force
/// error of a third of a newton. The default finger has such a direction within 9 degrees of the straight pose.
const FELT: f64 = 0.3;

/// The state of a fingertip.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct FingerTip {
    /// Position in the finger's frame, cm, from the measured joint angles.
    pub tip: [f64; 3],
    /// Force on the touched object in the finger's frame, N: J^-T R t (eqs. 1 and 13) with the measured tensions t. The
    /// force includes the effects of the finger's friction, weight and acceleration. It is never NaN: near the
    /// straight pose, the component in a direction that the joints do not feel is zero.
    pub force: [f64; 3],
    /// Number of directions that the joints feel: 3, or fewer near a singular pose.
    pub felt: usize,
    /// Measured tendon tensions, N.
    pub tensions: [f64; 4],
    /// Stiffness of the tip in the present pose, in the finger's frame, N/cm: the part of the sent stiffness that is in
    /// force, plus the stiffness that a rotational stiffness of the contact, the soft joint limits and the spring of
    /// joint 0 near its axis add. The tip turns as its joints turn it. It is zero in a direction that the joints do not
    /// feel, and while the finger is not a spring.
    pub stiffness: [[f64; 3]; 3],
    /// Force on the touched object in the finger's frame, N, without the friction, weight and acceleration of the
    /// finger, and without constant errors of the gauges: from the momentum observer of docs/contact.md. It is zero
    /// while the finger does not follow a set point.
    pub contact: [f64; 3],
    /// Whether the finger touches something, as far as tensions and motion show it.
    pub touching: bool,
    /// Speed of the tip perpendicular to `contact`, cm/s, while the finger touches something: the tip slides on the
    /// object, or moves it.
    pub slide: f64,
}

impl Hand {
    /// Position and force of the tip and tendon tensions of finger 1, 2 or 3, at most one cycle old.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if the finger is faulted.
    pub fn fingertip(&self, finger: i32) -> Result<FingerTip, HandError> {
        let finger = FingerNumber::try_from(finger)?;
        let report = self.dispatcher.report(finger)?;
        Ok(FingerTip::new(&self.dispatcher.member(finger)?.admission.read(), &report))
    }
}

impl FingerTip {
    fn new(admission: &Admission, report: &FingerReport) -> Self {
        let joints = &report.cycle.joints;
        let torques = admission.r * report.cycle.tensions; // eq. 13
        let (inverse, felt) = felt_inverse(&admission.links.jacobian(joints));
        let springs = admission.springs.as_ref().filter(|_| report.stage == Stage::Running);
        let held = springs.map_or_else(Matrix3::zeros, |springs| {
            springs.stiffness(&report.set_point, report.cycle.stiffness_scale, joints)
        });
        // Symmetric, so its rows are its columns.
        let stiffness = inverse.tr_mul(&(held * inverse));
        Self {
            tip: admission.links.tip(joints).into(),
            force: inverse.tr_mul(&torques).into(),
            felt,
            tensions: report.cycle.tensions.into(),
            stiffness: stiffness.into(),
            contact: (-report.cycle.contact.force).into(),
            touching: report.cycle.contact.touching,
            slide: report.cycle.contact.slide,
        }
    }
}

/// Returns the inverse of the Jacobian in the directions that the joints feel, rad/cm, and the number of these
/// directions. The inverse is zero in other directions. Its transpose converts joint torques to the smallest force f
/// with tau = J^T f.
fn felt_inverse(jacobian: &Matrix3<f64>) -> (Matrix3<f64>, usize) {
    // With the eigenvectors u and eigenvalues s^2 of J J^T: J^-1 = J^T (sum of u u^T / s^2).
    let eigen = (jacobian * jacobian.transpose()).symmetric_eigen();
    let mut inverse = Matrix3::zeros();
    let mut felt = 0;
    for (direction, &square) in eigen.eigenvectors.column_iter().zip(eigen.eigenvalues.iter()) {
        if square >= FELT * FELT {
            inverse += direction * direction.transpose() / square;
            felt += 1;
        }
    }
    (jacobian.tr_mul(&inverse), felt)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Links;
    use nalgebra::Vector3;

    #[test]
    fn the_force_is_the_one_that_makes_the_torque() {
        let links = Links([3.556, 5.080, 4.000]);
        let force = Vector3::new(0.5, -1.0, 2.0);
        let pose = |degrees: [f64; 3]| links.jacobian(&Vector3::from(degrees.map(f64::to_radians)));
        for degrees in [[0.0, 30.0, 60.0], [-40.0, 80.0, 110.0], [30.0, -20.0, 10.0]] {
            let jacobian = pose(degrees);
            let (inverse, felt) = felt_inverse(&jacobian);
            let found = inverse.tr_mul(&jacobian.tr_mul(&force));
            assert!(felt == 3 && (found - force).amax() < 1e-9, "{degrees:?}: {found}");
        }
        // In the straight pose, a force along the finger is not felt, and any other force is.
        for degrees in [[0.0, 0.0, 0.0], [0.0, 0.0, 5.0]] {
            let jacobian = pose(degrees);
            let (inverse, felt) = felt_inverse(&jacobian);
            let found = inverse.tr_mul(&jacobian.tr_mul(&force));
            assert!(felt == 2, "{degrees:?}");
            assert!((found.xy() - force.xy()).amax() < 0.2 && found.z.abs() < 0.2, "{found}");
        }
    }
}
