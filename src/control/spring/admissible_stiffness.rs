//! The stiffness that a pose supports: a finger cannot be stiffer than its tendons. K_theta is the commanded stiffness
//! of the joints. R k R^T is the stiffness with which the tendons hold the joints while the motors are locked.

use crate::control::eigenvalues::eigenvalues;
use crate::model::Tendons;
use crate::model::configuration::{ConfiguredFinger, Scheme};
use nalgebra::{Matrix3, Matrix3x4, Vector3};

/// Rate from which K_theta may use the larger fraction of R k R^T, Hz; see [`share`]. `FULL_RATE` of state feedback has
/// the same value, but is another limit: this one applies to Figures 9 and 10 too.
const LARGE_SHARE_RATE: f64 = 750.0;

/// Returns the fraction of R k R^T that K_theta may use; see [`AdmissibleStiffness`]. It is somewhat smaller than the
/// largest fraction with which the loop was stable. The fraction is smaller below [`LARGE_SHARE_RATE`] than above. With
/// Figure 11, which has no gain on the tension error, the small fraction applies at every rate.
fn share(scheme: Scheme, rate: f64) -> f64 {
    match scheme {
        Scheme::Figure11 => 0.7,
        _ if rate >= LARGE_SHARE_RATE => 0.95,
        // With a share of 0.95 at 500 Hz, the motion of a stretched finger at 5 N/cm grew instead of decaying.
        Scheme::StateFeedback => 0.75,
        Scheme::Figure9 | Scheme::Figure10 => 0.7,
    }
}

/// Returns R k R^T, the stiffness with which the tendons hold the joints while the motors are locked, N cm/rad. The
/// diagonal matrix k contains the stiffnesses of the tendons.
pub(crate) fn stiffness_of_tendons(finger: &ConfiguredFinger, tendons: &Tendons) -> Matrix3<f64> {
    let stiffness = finger.tendon.stiffness;
    let stretched = Matrix3x4::from_fn(|joint, tendon| tendons.r[(joint, tendon)] * stiffness[tendon]);
    stretched * tendons.r.transpose()
}

/// The shares of R k R^T that two stiffnesses use.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct UsedShares {
    /// The share that K_theta uses.
    pub spring: f64,
    /// The share that the stiffness of the soft joint limits uses.
    pub limits: f64,
}

/// Limits K_theta to a share of R k R^T = L L^T (see [`stiffness_of_tendons`]). The largest eigenvalue of L^-1 K_theta
/// L^-T is the largest share that K_theta uses in any direction.
#[derive(Clone, Debug)]
pub(crate) struct AdmissibleStiffness {
    /// L^-1, (N cm/rad)^(-1/2).
    inverse: Matrix3<f64>,
    /// The diagonal of (R k R^T)^-1, rad/(N cm).
    compliance: Vector3<f64>,
    share: f64,
}

impl AdmissibleStiffness {
    /// Constructs the limit for `finger` at `rate`, Hz. Returns None if the rank of R is below 3.
    pub fn new(finger: &ConfiguredFinger, tendons: &Tendons, rate: f64) -> Option<Self> {
        let inverse = stiffness_of_tendons(finger, tendons).cholesky()?.l().try_inverse()?;
        let compliance = inverse.tr_mul(&inverse).diagonal();
        Some(Self { inverse, compliance, share: share(finger.controller.scheme(rate), rate) })
    }

    /// Returns the share of R k R^T that each of two stiffnesses uses: K_theta, and that of the soft joint limits
    /// (`limits`). Both are in N cm/rad.
    ///
    /// The largest eigenvalue of a sum of matrices is at most the sum of their largest eigenvalues, so both together
    /// use at most the sum of the two shares. For the soft limits, the trace of L^-1 diag(`limits`) L^-T is used as the
    /// share, because it is at least as large as the largest eigenvalue of this matrix.
    #[inline]
    pub fn used(&self, k_theta: &Matrix3<f64>, limits: &Vector3<f64>) -> UsedShares {
        let [spring, ..] = eigenvalues(&self.relative(k_theta));
        UsedShares { spring, limits: limits.dot(&self.compliance) }
    }

    /// Returns the factor, 0 to 1, by which K_theta must be scaled so that K_theta and the soft joint limits together
    /// stay within the share.
    pub fn scale(&self, used: UsedShares) -> f64 {
        let left = self.share - used.limits;
        if used.spring > left { left / used.spring } else { 1.0 }
    }

    /// Returns L^-1 K_theta L^-T. The products with the zeros above the diagonal of L^-1 are left out.
    #[inline]
    fn relative(&self, k_theta: &Matrix3<f64>) -> Matrix3<f64> {
        let l = &self.inverse;
        let lower = |row: usize, [a, b, c]: [f64; 3]| match row {
            0 => l[(0, 0)] * a,
            1 => l[(1, 0)] * a + l[(1, 1)] * b,
            _ => l[(2, 0)] * a + l[(2, 1)] * b + l[(2, 2)] * c,
        };
        let half = Matrix3::from_fn(|row, column| lower(row, k_theta.column(column).into_owned().into()));
        Matrix3::from_fn(|row, column| lower(column, [half[(row, 0)], half[(row, 1)], half[(row, 2)]]))
    }

    /// Returns the largest stiffness that each joint can have while the other joints have none, N cm/rad.
    pub fn of_joints(&self) -> Vector3<f64> {
        self.compliance.map(|compliance| self.share / compliance)
    }
}
