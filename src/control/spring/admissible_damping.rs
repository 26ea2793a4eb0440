//! The range of relative damping that a planner may request.

use crate::model::configuration::{ConfiguredFinger, Scheme};
use nalgebra::{Matrix3, Matrix3x4};

/// Stiffness that the tendons of the default finger support in the middle of its joint ranges, N/cm. See [`supported`].
const DEFAULT_SUPPORTED: f64 = 12.306_708_616;

/// Below this rate, Hz, the delay of a cycle narrows the range.
const SLOW: f64 = 1000.0;

/// The range of relative damping, here called the ratio, with which a fingertip settles. The range narrows as the
/// stiffness grows.
///
/// The limits are straight lines inside the range in which the default finger was stable, with a margin of about a
/// tenth. Two tests determined that range: the one-cycle map at poses anywhere within the joint limits, and the closed
/// loop after steps of 5 mm and after pushes. They covered 500 to 4000 Hz and 0.3 to 6 N/cm, with and without friction.
/// From 1000 Hz up, the upper limit of state feedback is lower than these tests require, so that it also holds for the
/// named hands (`simulation.hand`) and for fingers whose links, tendons or amplifiers differ from the configuration
/// (`cargo bench --bench stiffness -- --truths --damping`). With too little damping the servo loses control of the
/// finger. With too much damping the finger oscillates because of the delay of one cycle. The schemes of the report's
/// figures have little damping besides the damping that the ratio scales, so they admit no ratio below 1. A ratio of 1
/// is always admitted: it is the damping that the controller computes, and a finger with this damping is stable up to
/// the bound of Kx.
///
/// For a finger with other links or tendons, the stiffness is first converted to a stiffness of the default finger.
/// Each of the two stiffnesses is the same fraction of the stiffness that the tendons of its own finger support.
///
/// The admitted pairs of stiffness and damping are not a convex set, because a ratio of 1 is admitted beyond the
/// straight lines. So the ratio can be outside its range during a transition between two springs. With the default
/// bound of Kx, the ratio of the default finger is outside by at most about 5 % of the limit. With tendons of 0.8 times
/// the stiffness, it is outside by up to about 25 %.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdmissibleDamping {
    /// Lower limit at zero stiffness, and its change for each N/cm of the default finger.
    least: (f64, f64),
    /// Upper limit at zero stiffness, and its change for each N/cm of the default finger.
    most: (f64, f64),
    /// Stiffness of the default finger that corresponds to 1 N/cm of this finger.
    correspondence: f64,
}

impl AdmissibleDamping {
    /// Constructs the range for the controller of `finger` at `rate`, Hz. If the rank of the moment arms R is below 3,
    /// only a ratio of 1 is admitted. No controller accepts such an R.
    pub fn new(finger: &ConfiguredFinger, rate: f64) -> Self {
        let scheme = finger.controller.scheme(rate);
        let correspondence = supported(finger).map_or(f64::INFINITY, |supported| DEFAULT_SUPPORTED / supported);
        let (least, most) = match (scheme, rate < SLOW) {
            (Scheme::StateFeedback, true) => ((0.7, 0.07), (2.0, -0.2)),
            (Scheme::StateFeedback, false) => ((0.4, 0.09), (2.1, -0.19)),
            (_, true) => ((1.0, 0.0), (2.0, -0.2)),
            (_, false) => ((1.0, 0.0), (2.5, -0.22)),
        };
        Self { least, most, correspondence }
    }

    /// Returns the smallest and the largest ratio for a spring whose largest eigenvalue is `stiffness`, N/cm. Both are
    /// rounded inward to multiples of 0.01, so that a planner reads exactly the range that is checked.
    pub fn range(&self, stiffness: f64) -> (f64, f64) {
        let at = |(limit, slope): (f64, f64)| limit + slope * (stiffness * self.correspondence);
        // The tolerance of 1e-9 absorbs the rounding of the product.
        let least = (at(self.least) * 100.0 - 1e-9).ceil() / 100.0;
        let most = (at(self.most) * 100.0 + 1e-9).floor() / 100.0;
        (least.min(1.0), most.max(1.0))
    }
}

/// Returns the smallest stiffness, over all directions, that locked tendons give the tip in the middle of the joint
/// ranges, N/cm. This is the smallest eigenvalue of J^-T (R k R^T) J^-1. Returns None if the rank of R is below 3.
fn supported(finger: &ConfiguredFinger) -> Option<f64> {
    let (low, high) = finger.joint_limits();
    let jacobian = finger.links().jacobian(&((low + high) * 0.5));
    let (r, stiffness) = (finger.r(), finger.tendon.stiffness);
    let stretched = Matrix3x4::from_fn(|joint, tendon| r[(joint, tendon)] * stiffness[tendon]);
    let inverse: Matrix3<f64> = (stretched * r.transpose()).cholesky()?.l().try_inverse()?;
    let largest = (inverse * jacobian.tr_mul(&jacobian) * inverse.transpose()).symmetric_eigenvalues().max();
    Some(1.0 / largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_finger_corresponds_to_itself() {
        let supported = supported(&ConfiguredFinger::default()).expect("R has rank 3");
        assert!((supported / DEFAULT_SUPPORTED - 1.0).abs() < 1e-6, "{supported}");
    }

    #[test]
    fn softer_tendons_narrow_the_range_as_a_stiffer_spring_does() {
        let mut finger = ConfiguredFinger::default();
        let whole = AdmissibleDamping::new(&finger, 1000.0);
        finger.tendon.stiffness = finger.tendon.stiffness.map(|stiffness| stiffness * 0.5);
        assert_eq!(AdmissibleDamping::new(&finger, 1000.0).range(2.0), whole.range(4.0));
        finger.geometry.r = [[0.0; 4]; 3];
        assert_eq!(AdmissibleDamping::new(&finger, 1000.0).range(1.0), (1.0, 1.0));
    }

    #[test]
    fn the_range_narrows_as_the_spring_gets_stiffer_and_always_contains_a_ratio_of_one() {
        for scheme in [Scheme::Figure9, Scheme::Figure10, Scheme::Figure11, Scheme::StateFeedback] {
            for rate in [500.0, 999.0, 1000.0, 5000.0] {
                let mut finger = ConfiguredFinger::default();
                finger.controller.scheme = Some(scheme);
                let admissible = AdmissibleDamping::new(&finger, rate);
                let ranges: Vec<_> = (0..=120).map(|tenths| admissible.range(f64::from(tenths) * 0.1)).collect();
                assert!(ranges.windows(2).all(|pair| pair[1].0 >= pair[0].0 && pair[1].1 <= pair[0].1));
                assert!(ranges.iter().all(|&(least, most)| least <= 1.0 && most >= 1.0));
                assert_eq!(ranges[120], (1.0, 1.0));
            }
        }
    }

    #[test]
    fn the_default_controller_has_the_ranges_of_the_manual() {
        let admissible = AdmissibleDamping::new(&ConfiguredFinger::default(), 1000.0);
        let ranges = [0.0, 1.0, 3.0, 6.0].map(|stiffness| admissible.range(stiffness));
        assert_eq!(ranges, [(0.4, 2.1), (0.49, 1.91), (0.67, 1.53), (0.94, 1.0)]);
        // The lines are at 0.535 and 1.815.
        assert_eq!(admissible.range(1.5), (0.54, 1.81));
    }
}
