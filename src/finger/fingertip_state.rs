//! The state of a fingertip, computed from the controller's report: for planners, and for readers of telemetry.

use crate::control::{JointSprings, Report, SetPoint};
use crate::model::Links;
use nalgebra::{Matrix3, Matrix3x4, Vector3};

/// Limit of observability, cm per rad. If a joint motion of 1 rad moves the fingertip in a direction by less than this,
/// the force in that direction cannot be found from the joint torques: a torque error of 0.1 N cm would cause a force
/// error of a third of a newton. The joints do not feel a force in such a direction. The default finger has such a
/// direction while joint 2 is within 8.4 degrees of the straight pose.
const FELT: f64 = 0.3;

/// The state of a fingertip, in the finger's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FingertipState {
    /// Position, cm, from the measured joint angles.
    pub tip: Vector3<f64>,
    /// Force on the touched object, N: J^-T R t (eqs. 1 and 13 of COINS TR 90-48) with the Jacobian J, the moment arms
    /// R and the measured tensions t.
    pub force: Vector3<f64>,
    /// Number of directions in which the joint torques determine the force.
    pub felt: usize,
    /// Joint torques R t with the measured tensions, N cm.
    pub torques: Vector3<f64>,
    /// Stiffness of the tip in the present pose, N/cm. It is zero in a direction that the joints do not feel.
    pub stiffness: Matrix3<f64>,
}

impl FingertipState {
    /// Returns the state of the tip of a finger with these links and these moment arms `r`. `spring` is none for a
    /// finger that does not follow set points. The stiffness is then zero.
    pub fn new(links: Links, r: &Matrix3x4<f64>, report: &Report, spring: Option<(&JointSprings, &SetPoint)>) -> Self {
        let joints = &report.joints;
        let torques = r * report.tensions; // eq. 13
        let (inverse, felt) = felt_inverse(&links.jacobian(joints));
        let held = spring.map_or_else(Matrix3::zeros, |(springs, set_point)| {
            springs.stiffness(set_point, report.stiffness_scale, joints)
        });
        Self {
            tip: links.tip(joints),
            force: inverse.tr_mul(&torques),
            felt,
            torques,
            stiffness: inverse.tr_mul(&(held * inverse)),
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
        // In the straight pose and near it, a force along the finger is not felt. Forces across the finger are felt.
        for degrees in [[0.0, 0.0, 0.0], [0.0, 0.0, 5.0]] {
            let jacobian = pose(degrees);
            let (inverse, felt) = felt_inverse(&jacobian);
            let found = inverse.tr_mul(&jacobian.tr_mul(&force));
            assert!(felt == 2, "{degrees:?}");
            assert!((found.xy() - force.xy()).amax() < 0.2 && found.z.abs() < 0.2, "{found}");
        }
    }
}
