//! How much more or less damping than the controller's own a planner may ask for.

use crate::model::configuration::{ConfiguredFinger, Scheme};
use nalgebra::{Matrix3, Matrix3x4};

/// What the tendons of the default finger carry in the middle of its joints' ranges, N/cm: see [`carried`].
const DEFAULT_CARRIED: f64 = 12.306_708_616;

/// Below this rate, Hz, the delay of a cycle leaves less room.
const SLOW: f64 = 1000.0;

/// The relative damping for which a fingertip comes to rest: a range that narrows as the spring gets stiffer.
///
/// The lines were drawn inside what was found stable on the default finger, with a margin of about a tenth: in the
/// one-cycle map at poses anywhere within the joint limits, and in the closed loop after steps of 5 mm and pushes, with
/// and without friction, at 500 to 4000 Hz and 0.3 to 6 N/cm. Too little damping loses the finger. Too much swings with
/// the delay of a cycle. The figures of the report are damped hardly enough by themselves, so none of them offers less.
/// A ratio of 1 is always admitted: it is the controller's own damping, whose stability the bound of Kx covers.
///
/// A finger with other links or tendons has the range of the default finger whose spring is the same part of what its
/// tendons carry.
///
/// Both limits are straight lines, so a change from one admitted pair of stiffness and damping to another passes
/// through admitted pairs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AdmissibleDamping {
    /// Limits of a finger without stiffness, and how much they change by each N/cm of Kx.
    least: (f64, f64),
    most: (f64, f64),
    /// The stiffness of the default finger that corresponds to 1 N/cm of this one.
    correspondence: f64,
}

impl AdmissibleDamping {
    /// For the controller of `finger` at `rate`, Hz. Where R has no rank of 3, which makes no controller either, only 1
    /// is admitted.
    pub fn new(finger: &ConfiguredFinger, rate: f64) -> Self {
        let scheme = finger.controller.scheme(rate);
        let correspondence = carried(finger).map_or(f64::INFINITY, |carried| DEFAULT_CARRIED / carried);
        let (least, most) = match rate < SLOW {
            true => ((0.7, 0.07), (2.0, -0.2)),
            false => ((0.4, 0.09), (2.5, -0.22)),
        };
        let least = if scheme == Scheme::StateFeedback { least } else { (1.0, 0.0) };
        Self { least, most, correspondence }
    }

    /// The least and the greatest ratio for a spring whose largest eigenvalue is `stiffness`, N/cm. Multiples of 0.01,
    /// so that the range that a planner reads is the range that counts.
    pub fn range(&self, stiffness: f64) -> (f64, f64) {
        let at = |(limit, slope): (f64, f64)| limit + slope * (stiffness * self.correspondence);
        // Whole steps of 0.01, except for the rounding of the product.
        let least = (at(self.least) * 100.0 - 1e-9).ceil() / 100.0;
        let most = (at(self.most) * 100.0 + 1e-9).floor() / 100.0;
        (least.min(1.0), most.max(1.0))
    }
}

/// The stiffness that locked tendons give the tip at least in one direction, N/cm, in the middle of the joints' ranges:
/// the smallest eigenvalue of J^-T (R k R^T) J^-1.
fn carried(finger: &ConfiguredFinger) -> Option<f64> {
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
        let carried = carried(&ConfiguredFinger::default()).expect("R has rank 3");
        assert!((carried / DEFAULT_CARRIED - 1.0).abs() < 1e-6, "{carried}");
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
    fn the_range_narrows_as_the_spring_gets_stiffer_and_never_excludes_one() {
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
        assert_eq!(ranges, [(0.4, 2.5), (0.49, 2.28), (0.67, 1.84), (0.94, 1.18)]);
    }
}
