//! What is known of a fingertip: where it is, what it presses and how its tendons pull.

use crate::finger::FingerReport;
use crate::hand::admission::Admission;
use crate::hand::{Hand, HandError};
use nalgebra::{Matrix3, Vector3};

/// A direction of the fingertip that moves by less than this, cm for a turn of the joints by 1 rad, is not felt in
/// their torques: an error of 0.1 N cm would be a third of a newton. The default finger is so within 9 degrees of
/// straight.
const FELT: f64 = 0.3;

/// What is known of a fingertip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingerTip {
    /// Where it is in the finger's frame, cm: from the measured joint angles.
    pub tip: [f64; 3],
    /// What it does to the thing it touches, in the finger's frame, N: J^-T R t (eqs. 1 and 13) with the measured
    /// tensions t. So friction and weight of the finger and the torque that accelerates it are in it. Never NaN: along
    /// a direction in which a pose near the straight one leaves the joints without feeling it is zero.
    pub force: [f64; 3],
    /// How many directions the joints feel: 3, and fewer near a singular pose.
    pub felt: usize,
    /// Measured tendon tensions, N.
    pub tensions: [f64; 4],
}

impl Hand {
    /// Where the tip of finger 1, 2 or 3 is, what it presses and how its tendons pull, not older than a cycle.
    ///
    /// # Errors
    /// No such finger, finger faulted.
    pub fn fingertip(&self, finger: i32) -> Result<FingerTip, HandError> {
        let report = self.dispatcher.report(finger)?;
        Ok(FingerTip::new(&self.dispatcher.member(finger)?.admission.read(), &report))
    }
}

impl FingerTip {
    fn new(admission: &Admission, report: &FingerReport) -> Self {
        let joints = &report.cycle.joints;
        let torques = admission.r * report.cycle.tensions; // eq. 13
        let (force, felt) = tip_force(&admission.links.jacobian(joints), &torques);
        Self {
            tip: admission.links.tip(joints).into(),
            force: force.into(),
            felt,
            tensions: report.cycle.tensions.into(),
        }
    }
}

/// The smallest force with tau = J^T f in the directions that are felt, and how many these are.
fn tip_force(jacobian: &Matrix3<f64>, torques: &Vector3<f64>) -> (Vector3<f64>, usize) {
    // By the eigenvectors of J J^T: J^-T tau = sum of u (u . J tau) / s^2 over them, s^2 the eigenvalues.
    let eigen = (jacobian * jacobian.transpose()).symmetric_eigen();
    let pushed = jacobian * torques;
    let mut force = Vector3::zeros();
    let mut felt = 0;
    for (direction, &square) in eigen.eigenvectors.column_iter().zip(eigen.eigenvalues.iter()) {
        if square >= FELT * FELT {
            force += direction * (direction.dot(&pushed) / square);
            felt += 1;
        }
    }
    (force, felt)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Links;

    #[test]
    fn the_force_is_the_one_that_makes_the_torque() {
        let links = Links([3.556, 5.080, 4.000]);
        let force = Vector3::new(0.5, -1.0, 2.0);
        let pose = |degrees: [f64; 3]| links.jacobian(&Vector3::from(degrees.map(f64::to_radians)));
        for degrees in [[0.0, 30.0, 60.0], [-40.0, 80.0, 110.0], [30.0, -20.0, 10.0]] {
            let jacobian = pose(degrees);
            let (found, felt) = tip_force(&jacobian, &(jacobian.transpose() * force));
            assert!(felt == 3 && (found - force).amax() < 1e-9, "{degrees:?}: {found}");
        }
        // Straight: what pushes along the finger is not felt, all else is.
        for degrees in [[0.0, 0.0, 0.0], [0.0, 0.0, 5.0]] {
            let jacobian = pose(degrees);
            let (found, felt) = tip_force(&jacobian, &(jacobian.transpose() * force));
            assert!(felt == 2, "{degrees:?}");
            assert!((found.xy() - force.xy()).amax() < 0.2 && found.z.abs() < 0.2, "{found}");
        }
    }
}
