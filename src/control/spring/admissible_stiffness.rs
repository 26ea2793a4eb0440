//! What a pose can carry: a finger is never stiffer than its tendons.

use crate::control::eigenvalues::eigenvalues;
use crate::model::Tendons;
use crate::model::configuration::{ConfiguredFinger, Scheme};
use nalgebra::{Matrix3, Matrix3x4, Vector3};

/// The part of the stiffness of the locked tendons that K_theta may have: as far as the loop was found stable, so less
/// below 750 Hz, and less with Figure 11, which has no gain on the tension error, at every rate.
fn share(scheme: Scheme, rate: f64) -> f64 {
    match scheme {
        Scheme::Figure11 => 0.7,
        _ if rate >= 750.0 => 0.95,
        // At 500 Hz: with 0.95 stretched poses grew at 5 N/cm.
        Scheme::StateFeedback => 0.75,
        Scheme::Figure9 | Scheme::Figure10 => 0.7,
    }
}

/// Locked tendons hold the joints with R k R^T = L L^T. The largest eigenvalue of L^-1 K_theta L^-T is the largest part
/// of that, over all directions, which K_theta asks for.
#[derive(Clone, Debug)]
pub(crate) struct AdmissibleStiffness {
    /// L^-1, (N cm/rad)^(-1/2).
    inverse: Matrix3<f64>,
    /// The diagonal of (R k R^T)^-1, rad/(N cm).
    compliance: Vector3<f64>,
    share: f64,
}

impl AdmissibleStiffness {
    /// For `finger` at `rate`, Hz. None where R has no rank of 3.
    pub fn new(finger: &ConfiguredFinger, tendons: &Tendons, rate: f64) -> Option<Self> {
        let stiffness = finger.tendon.stiffness;
        let stretched = Matrix3x4::from_fn(|joint, tendon| tendons.r[(joint, tendon)] * stiffness[tendon]);
        let inverse = (stretched * tendons.r.transpose()).cholesky()?.l().try_inverse()?;
        let compliance = inverse.tr_mul(&inverse).diagonal();
        Some(Self { inverse, compliance, share: share(finger.controller.scheme(rate), rate) })
    }

    /// The factor, 0 to 1, that K_theta has to be scaled by beside what joints at their limits have of their own; all N
    /// cm/rad.
    ///
    /// The largest eigenvalue of a sum is at most the sum of the largest ones, and that of the limits at most their
    /// trace.
    pub fn scale(&self, k_theta: &Matrix3<f64>, limits: &Vector3<f64>) -> f64 {
        let [largest, ..] = eigenvalues(&(self.inverse * k_theta * self.inverse.transpose()));
        let left = self.share - limits.dot(&self.compliance);
        if largest > left { left / largest } else { 1.0 }
    }

    /// What each joint can have if the others have nothing, N cm/rad.
    pub fn of_joints(&self) -> Vector3<f64> {
        self.compliance.map(|compliance| self.share / compliance)
    }
}
