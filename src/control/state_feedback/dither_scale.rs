//! Adapts the amplitude of the tension dither to the spring of the finger and to contact, if the pulley friction is
//! known.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// If the softest joint has this firmness, 1/rad, the amplitude is not changed. The firmness is the stiffness of a
/// joint divided by the sum of the magnitudes of the torques of its four tendons at the pretension.
const FIRMNESS: f64 = 2.0;

/// Like [`FIRMNESS`], but for the firmness of a joint while the other joints are free, 1/rad. This firmness is small if
/// the finger is nearly straight. With 0.2, at 3 N/cm the amplitude is smallest if joint 2 is bent by 32 degrees or
/// more, and the factor is 1 at 22 degrees.
const FREE_FIRMNESS: f64 = 0.2;

/// Range of the factor on the amplitude. With a factor of up to 2.5, the finger is more exact in the softest poses,
/// but creeps there for up to 0.76 s after a step.
const FACTORS: [f64; 2] = [0.7, 2.0];

/// Additional factor on the amplitude while the finger touches something, because at walls the dither moves the tip.
const TOUCHING: f64 = 0.7;

/// Time constant with which the factor [`TOUCHING`] begins and ceases to act, s.
const CHANGING: f64 = 0.05;

/// If the dither keeps a tendon sliding on its pulleys, their friction acts like viscous friction. A finger that was
/// pushed therefore approaches its rest position with a time constant that is inversely proportional to the stiffness
/// of the joints and to the amplitude of the dither. In a pose in which the tip is close to the axis of a joint, this
/// joint is soft. In a nearly straight finger, the motion of joints 1 and 2 that moves the tip along the links is soft.
/// In both cases the amplitude is larger. In poses with stiff joints, the tip has a long lever. A smaller amplitude
/// suffices there, and moves the tip less.
#[derive(Clone, Debug)]
pub(super) struct DitherScale {
    /// For each joint, 1 / the sum of the magnitudes of the torques of the four tendons at the pretension, 1/(N cm).
    inverse_torques: Vector3<f64>,
    changing: f64,
}

/// The degree to which the factor [`TOUCHING`] acts: from 0 without contact to 1 in lasting contact.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(super) struct DitherScaleState(f64);

impl DitherScale {
    /// `torques` has, for each joint, the sum of the magnitudes of the torques of the four tendons at the pretension,
    /// N cm. `rate` is the rate of the servo, Hz.
    pub fn new(torques: &Vector3<f64>, rate: f64) -> Self {
        Self { inverse_torques: torques.map(f64::recip), changing: (1.0 / (CHANGING * rate)).min(1.0) }
    }

    /// Returns the factor on the amplitude. `k_theta` is the stiffness of the joints, N cm/rad. `touches` is true if
    /// the spring exerts so much torque that the finger probably touches something.
    pub fn advance(&self, state: &mut DitherScaleState, k_theta: &Matrix3<f64>, touches: bool) -> f64 {
        state.0 += (f64::from(touches) - state.0) * self.changing;
        let softness = (FIRMNESS * self.most_per(&k_theta.diagonal()))
            .max(FREE_FIRMNESS * self.most_per(&stiffness_with_free_joints(k_theta)));
        let factor = if softness > 0.0 { softness.sqrt().clamp(FACTORS[0], FACTORS[1]) } else { 1.0 };
        factor * (1.0 - (1.0 - TOUCHING) * state.0)
    }

    /// Returns the reciprocal of the smallest firmness, or zero if no joint has a spring. Joints without a spring do
    /// not count, because they have no rest position.
    fn most_per(&self, stiffness: &Vector3<f64>) -> f64 {
        let firmness = stiffness.component_mul(&self.inverse_torques);
        firmness.iter().filter(|firmness| **firmness > 0.0).fold(0.0, |most, firmness| firmness.recip().max(most))
    }
}

/// Returns, for each joint, 1 / the diagonal entry of K_theta^-1: its stiffness while the other joints are free.
fn stiffness_with_free_joints(k: &Matrix3<f64>) -> Vector3<f64> {
    let minor = |a: usize, b: usize| k[(a, a)] * k[(b, b)] - k[(a, b)] * k[(b, a)];
    Vector3::new(minor(1, 2), minor(0, 2), minor(0, 1)).map(f64::recip) * k.determinant()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::configuration::ConfiguredFinger;
    use proptest::prelude::*;

    const RATE: f64 = 1000.0;

    /// Returns the factor on the amplitude after 1 s, for joints with these values of the firmness, 1/rad.
    fn after_a_second(firmness: [f64; 3], touches: bool) -> f64 {
        let torques = Vector3::new(20.0, 20.0, 10.0);
        let scale = DitherScale::new(&torques, RATE);
        let k_theta = Matrix3::from_diagonal(&torques.component_mul(&Vector3::from(firmness)));
        let mut state = DitherScaleState::default();
        (0..1000).map(|_| scale.advance(&mut state, &k_theta, touches)).last().expect("cycles")
    }

    #[test]
    fn the_softest_joint_determines_the_factor() {
        for (firmness, expected) in
            [([2.0, 9.0, 4.0], 1.0), ([9.0, 1.0, 4.0], 2f64.sqrt()), ([9.0, 9.0, 3.0], (2.0 / 3.0f64).sqrt())]
        {
            let found = after_a_second(firmness, false);
            assert!((found - expected).abs() < 1e-9, "{found} instead of {expected}");
        }
    }

    #[test]
    fn the_factor_is_limited_for_every_spring_and_joints_without_a_spring_do_not_count() {
        let nan = f64::NAN;
        for (firmness, expected) in [
            ([0.0; 3], 1.0),
            ([nan; 3], 1.0),
            ([1e-300; 3], 2.0),
            ([1e9; 3], 0.7),
            ([0.0, 2.0, 9.0], 1.0),
            ([-1.0, 2.0, 9.0], 1.0),
        ] {
            assert_eq!(after_a_second(firmness, false), expected, "{firmness:?}");
        }
    }

    #[test]
    fn a_nearly_straight_finger_has_a_larger_amplitude() {
        let finger = ConfiguredFinger::default();
        let tendons = finger.tendons().expect("the default tendons");
        let scale = DitherScale::new(&(tendons.r.abs() * tendons.pretension(5.0)), RATE);
        let factor = |degrees: f64| {
            let jacobian = finger.links().jacobian(&Vector3::new(0.0, 0.0, degrees.to_radians()));
            scale.advance(&mut DitherScaleState::default(), &(jacobian.transpose() * jacobian * 3.0), false)
        };
        assert_eq!((factor(5.0), factor(10.0), factor(45.0)), (2.0, 2.0, 0.7));
        assert!((1.0..1.2).contains(&factor(20.0)), "{}", factor(20.0));
    }

    proptest! {
        #[test]
        fn the_stiffness_with_free_joints_is_that_of_the_inverse(entries in prop::array::uniform9(-1.0..1.0f64)) {
            let root = Matrix3::from_row_slice(&entries) + Matrix3::identity() * 2.0;
            let k = root * root.transpose();
            let inverse = k.try_inverse().expect("a positive definite matrix");
            let found = stiffness_with_free_joints(&k).component_mul(&inverse.diagonal());
            prop_assert!((found - Vector3::repeat(1.0)).amax() < 1e-6, "{found}");
        }
    }

    #[test]
    fn contact_reduces_the_amplitude_gradually() {
        let found = after_a_second([2.0; 3], true);
        assert!((found - TOUCHING).abs() < 1e-6, "{found}");
        let scale = DitherScale::new(&Vector3::repeat(10.0), RATE);
        let mut state = DitherScaleState::default();
        let first = scale.advance(&mut state, &Matrix3::from_diagonal_element(20.0), true);
        assert!((1.0 - first - (1.0 - TOUCHING) * 0.02).abs() < 1e-12, "{first}");
    }
}
