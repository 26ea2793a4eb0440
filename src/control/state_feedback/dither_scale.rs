//! Adapts the dither of the tensions of a finger with known pulley friction to its spring and to contact.

use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// Stiffness of a joint, divided by the sum of the magnitudes of the torques of its four tendons at the pretension,
/// for which the amplitude is not changed, 1/rad.
const FIRMNESS: f64 = 2.0;

/// Range of the factor on the amplitude. With a factor of up to 2.5 the softest poses are more exact, but they creep
/// for up to 0.76 s after a step.
const FACTORS: [f64; 2] = [0.7, 2.0];

/// Additional factor on the amplitude of a finger that touches something. At walls the dither moves the tip.
const TOUCHING: f64 = 0.7;

/// Time constant with which this factor begins and ceases to act, s.
const CHANGING: f64 = 0.05;

/// Pulleys that dither keeps sliding act like viscous friction. A finger that was pushed therefore approaches its rest
/// position with a time constant that is proportional to the friction of the pulleys, and inversely proportional to the
/// stiffness of the joints and to the amplitude of the dither. In a pose in which the tip is close to the axis of a
/// joint, this joint is soft. There the amplitude is larger. In poses with stiff joints a smaller amplitude suffices,
/// and the tip, which has a long lever, moves less.
#[derive(Clone, Debug)]
pub(super) struct DitherScale {
    /// For each joint, 1 / the sum of the magnitudes of the torques of the four tendons at the pretension, 1/(N cm).
    inverse_torques: Vector3<f64>,
    changing: f64,
}

/// How far the factor for a finger that touches something acts, from 0 to 1.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(super) struct DitherScaleState(f64);

impl DitherScale {
    /// `torques` has, for each joint, the sum of the magnitudes of the torques of the four tendons at the pretension,
    /// N cm. `rate` is the rate of the servo, Hz.
    pub fn new(torques: &Vector3<f64>, rate: f64) -> Self {
        Self { inverse_torques: torques.map(f64::recip), changing: (1.0 / (CHANGING * rate)).min(1.0) }
    }

    /// Returns the factor on the amplitude. `k_theta` is the stiffness of the joints, N cm/rad. `touches` tells that
    /// the spring exerts so much torque that the finger touches something.
    pub fn advance(&self, state: &mut DitherScaleState, k_theta: &Matrix3<f64>, touches: bool) -> f64 {
        state.0 += (f64::from(touches) - state.0) * self.changing;
        let firmness = k_theta.diagonal().component_mul(&self.inverse_torques).min();
        // A spring that is not positive has the largest factor too.
        let factor = (FIRMNESS / firmness.max(f64::MIN_POSITIVE)).sqrt().clamp(FACTORS[0], FACTORS[1]);
        factor * (1.0 - (1.0 - TOUCHING) * state.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 1000.0;

    /// Returns the factor after 1 s with these stiffnesses of the joints, relative to the torques.
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
    fn the_factor_is_limited_for_every_spring() {
        for (firmness, expected) in [([0.0; 3], 2.0), ([-1.0, 1.0, 1.0], 2.0), ([1e9; 3], 0.7)] {
            assert_eq!(after_a_second(firmness, false), expected);
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
