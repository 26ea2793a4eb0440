//! A stiffer spring during a fast motion of the reference.
//!
//! The gauges do not measure the friction of the pulleys. It holds the joints back: they lag the reference by about
//! K_theta^-1 F, where F is the torque of the friction. After the motion they creep to their rest position: the dither
//! keeps the tendons sliding on the pulleys, and the friction then acts like viscous friction. If the tip is close to
//! the axis of joint 0, or the finger is nearly straight, K_theta is small in one direction. The lag is then larger
//! than 5 % of a step of 5 mm.
//!
//! The additional stiffness is sigma R k R^T, a share of the stiffness that the tendons give the joints. In each
//! direction, K_theta is a fraction of R k R^T. The additional stiffness adds sigma to this fraction in all directions.
//! So it helps most in the directions in which K_theta is small, and changes little in the stiff directions, in which
//! the loop has less margin.
//!
//! The additional stiffness decays soon after the motion. So a finger whose reference is at rest becomes the commanded
//! spring again.

use super::dither_burst::{FAST, SLOW};
use super::full_rate::FULL_RATE;
use super::numbers::Numbers;
use crate::control::spring::admissible_stiffness::UsedShares;
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// Largest share of R k R^T that the spring, the soft joint limits and the additional stiffness use together. With
/// 0.68, steps of fingers with rotors of half the inertia did not settle in some poses.
const SUPPORTED: f64 = 0.57;
/// Largest sigma, as a fraction of the share that the spring uses. So a finger with zero stiffness stays limp.
const LARGEST_RATIO: f64 = 0.5;
/// Largest additional torque, as a fraction of the sum of the magnitudes of the torques that the four tendons exert on
/// the joint at the pretension. An object in the way of the finger meets at most this additional torque.
const LARGEST: f64 = 0.05;

/// Time constant with which the stiffness rises, s.
const RISING: f64 = 0.01;
/// Time constant with which the stiffness decays after the motion, s. With wrong gauges or moment arms, the additional
/// stiffness changes the rest position, and the finger must return while the stiffness decays. When the stiffness
/// stayed for 0.12 s and then decayed with 0.08 s, steps of "cheap" fingers (see `simulation.hand`) settled in
/// 361 instead of 168 ms.
const DECAYING: f64 = 0.02;
/// If the envelope ([`StiffeningState`]) decays below this value, the additional stiffness becomes zero.
const ENDED: f64 = 1e-3;
/// Time constant of the filter that finds the deflection before a motion, s.
const RESTING: f64 = 0.1;

/// Adds sigma R k R^T (d - d_0) to the torque of the spring. d is the deflection of the joints, and d_0 is the
/// deflection before the motion. d_0 is not zero if an object loads the finger, or if gauges or moment arms are wrong.
/// Without d_0, the finger would move when sigma rises.
#[derive(Clone, Debug)]
pub(super) struct Stiffening {
    /// R k R^T, N cm/rad.
    tendons: Matrix3<f64>,
    /// Largest sigma.
    most: f64,
    /// Largest additional torque, N cm.
    largest: Vector3<f64>,
    rising: f64,
    decay: f64,
    resting: f64,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(super) struct StiffeningState {
    /// d_0, rad.
    rest: Vector3<f64>,
    /// Sigma as a fraction of its present upper limit, 0 to 1. It rises during a fast motion, and decays afterwards.
    envelope: f64,
    /// Whether a fast motion is in progress.
    fast: bool,
}

/// What is added to the spring.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Added {
    /// Stiffness, N cm/rad.
    pub stiffness: Matrix3<f64>,
    /// Torques, N cm.
    pub torques: Vector3<f64>,
}

impl Stiffening {
    /// `tendons` is R k R^T, N cm/rad. `torques` has, for each joint, the sum of the magnitudes of the torques of the
    /// four tendons at the pretension, N cm. `identified` is true if the friction of the pulleys is known. `rate` is
    /// the rate of the servo, Hz. Returns None if there is no additional stiffness.
    pub fn new(
        tendons: Matrix3<f64>,
        torques: &Vector3<f64>,
        identified: bool,
        numbers: &Numbers,
        rate: f64,
    ) -> Option<Self> {
        let most = if identified { numbers.identified_stiffening } else { numbers.stiffening };
        // At 500 Hz, a loop with a stiff spring has little margin.
        (most > 0.0 && rate >= FULL_RATE).then(|| Self {
            tendons,
            most,
            largest: torques * LARGEST,
            rising: (1.0 / (RISING * rate)).min(1.0),
            decay: (-1.0 / (DECAYING * rate)).exp(),
            resting: (1.0 / (RESTING * rate)).min(1.0),
        })
    }

    /// Returns what is added in this cycle. `rates` are the joint rates of the reference, rad/s. `deflection` is the
    /// reference minus the joint angles, rad. `used` is what the spring and the soft joint limits use of R k R^T.
    pub fn advance(
        &self,
        state: &mut StiffeningState,
        (rates, deflection): (&Vector3<f64>, &Vector3<f64>),
        used: UsedShares,
    ) -> Added {
        let rate = rates.amax();
        state.fast = rate >= FAST || (rate >= SLOW && state.fast);
        if state.fast {
            state.envelope += (1.0 - state.envelope) * self.rising;
        } else {
            let envelope = state.envelope * self.decay;
            state.envelope = if envelope < ENDED { 0.0 } else { envelope };
        }
        let change = deflection - state.rest;
        state.rest += change * (self.resting * (1.0 - state.envelope));
        if state.envelope == 0.0 {
            return Added::default();
        }
        let most = self.most.min(LARGEST_RATIO * used.spring);
        // `max` comes before `min`, so that a NaN gives zero.
        let share = state.envelope * (SUPPORTED - used.spring - used.limits).max(0.0).min(most);
        let stiffness = self.tendons * share;
        let torques = (stiffness * change).zip_map(&self.largest, |torque, largest| torque.clamp(-largest, largest));
        Added { stiffness, torques }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::configuration::ConfiguredController;

    const RATE: f64 = 1000.0;

    fn numbers(rate: f64) -> Numbers {
        Numbers::new(&ConfiguredController::default(), rate).expect("usable numbers")
    }

    /// Runs the law for `time` (s) with a reference of this rate, rad/s, this deflection of joint 0, rad, and a spring
    /// that uses this share.
    fn after(state: &mut StiffeningState, time: f64, (rate, deflection, spring): (f64, f64, f64)) -> Added {
        let numbers = Numbers { stiffening: 0.1, ..numbers(RATE) };
        let tendons = Matrix3::from_diagonal_element(100.0);
        let law = Stiffening::new(tendons, &Vector3::new(20.0, 20.0, 10.0), false, &numbers, RATE).expect("a law");
        let (rates, deflection) = (Vector3::new(0.0, -rate, 0.0), Vector3::new(deflection, 0.0, 0.0));
        let used = UsedShares { spring, limits: 0.0 };
        let cycles = (time * RATE) as usize;
        (0..cycles).map(|_| law.advance(state, (&rates, &deflection), used)).last().expect("cycles")
    }

    #[test]
    fn a_fast_motion_makes_the_spring_stiffer_until_it_ends() {
        let mut state = StiffeningState::default();
        assert_eq!(after(&mut state, 1.0, (0.0, 0.02, 0.2)).stiffness[(0, 0)], 0.0);
        let Added { stiffness, torques } = after(&mut state, 0.1, (4.0, 0.05, 0.2));
        assert!((stiffness[(0, 0)] - 10.0).abs() < 0.01, "{stiffness}");
        assert!((torques - Vector3::x() * 0.3).amax() < 0.03, "{torques}");
        assert!(after(&mut state, 0.1, (0.0, 0.05, 0.2)).stiffness[(0, 0)] < 0.1, "{state:?}");
        assert_eq!(after(&mut state, 0.1, (0.0, 0.05, 0.2)).stiffness[(0, 0)], 0.0, "{state:?}");
        assert_eq!(after(&mut state, 1.0, (0.39, 0.05, 0.2)).stiffness[(0, 0)], 0.0, "a slow motion");
    }

    #[test]
    fn the_pose_and_the_torques_of_the_tendons_limit_what_is_added() {
        for (spring, expected) in [(0.5, 0.07), (0.6, 0.0), (0.1, 0.05), (0.0, 0.0), (f64::NAN, 0.0)] {
            let found = after(&mut StiffeningState::default(), 0.2, (4.0, 0.0, spring)).stiffness[(1, 1)] / 100.0;
            assert!((found - expected).abs() < 1e-6, "{spring}: {found}");
        }
        let torques = after(&mut StiffeningState::default(), 0.1, (4.0, -5.0, 0.2)).torques;
        assert!((torques + Vector3::x() * (LARGEST * 20.0)).amax() < 1e-12, "{torques}");
    }

    #[test]
    fn below_750_hz_the_stiffness_does_not_change() {
        let law = |rate| Stiffening::new(Matrix3::identity(), &Vector3::repeat(20.0), true, &numbers(rate), rate);
        assert!(law(500.0).is_none());
        assert!(law(RATE).is_some());
    }
}
