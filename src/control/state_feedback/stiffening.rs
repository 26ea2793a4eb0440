//! A stiffer spring during a fast motion of the reference and shortly after it.
//!
//! The gauges do not measure the friction of the pulleys. It holds the joints back: they lag the reference by about
//! K_theta^-1 F, where F is the torque of the friction. After the motion they creep to their rest position, because
//! pulleys that the dither keeps sliding act like viscous friction. If the tip is close to the axis of joint 0, or the
//! finger is nearly straight, K_theta is small in one direction. The lag is then larger than 5 % of a step of 5 mm.
//! With the additional stiffness g K_theta, the lag is smaller by the factor 1 + g, and the joints creep faster by
//! almost this factor.
//!
//! The additional torque is zero in the rest position of the spring, and it ends soon after the motion. So the finger
//! is the commanded spring whenever its reference is at rest.

use super::dither_burst::{FAST, HELD, SLOW};
use super::numbers::Numbers;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Largest stiffness of the stiffer spring, as a fraction of the stiffness that the pose supports.
const SUPPORTED: f64 = 0.8;
/// Largest additional torque, as a fraction of the sum of the magnitudes of the torques that the four tendons exert on
/// the joint at the pretension. An object in the way of the finger meets at most this additional torque.
const LARGEST: f64 = 0.05;

/// Time constant with which the stiffness rises, s.
const RISING: f64 = 0.01;
/// Time for which the spring stays stiffer after a motion, s.
const STAYING: f64 = 0.12;
/// Time constant with which the additional stiffness decays, s. The burst of the dither decays as fast.
const DECAYING: f64 = 0.08;
/// Part of the additional stiffness below which it becomes zero.
const ENDED: f64 = 1e-3;
/// Time constant of the filter that finds the torque of the spring before a motion, s.
const RESTING: f64 = 0.1;

/// Adds g (tau - tau_0) to the torque tau of the spring. tau_0 is the torque before the motion. It is not zero if an
/// object loads the finger, or if gauges or moment arms are wrong. Without tau_0, the rest position would change while
/// g decays.
#[derive(Clone, Debug)]
pub(super) struct Stiffening {
    /// Largest g.
    most: f64,
    /// Largest additional torque, N cm.
    largest: Vector3<f64>,
    /// Largest change of the torque of the spring with which the spring stays stiffer after a motion, N cm. A larger
    /// one usually means that the finger has touched something.
    held: Vector3<f64>,
    period: f64,
    rising: f64,
    decay: f64,
    resting: f64,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(super) struct StiffeningState {
    /// tau_0, N cm.
    rest: Vector3<f64>,
    /// From 0 to 1.
    envelope: f64,
    /// Time for which the spring still stays stiffer, s. Zero: no fast motion, or it has ended long enough ago.
    staying: f64,
}

/// What is added to the spring.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Added {
    /// g.
    pub part: f64,
    /// Torques, N cm.
    pub torques: Vector3<f64>,
}

impl Stiffening {
    /// `torques` has, for each joint, the sum of the magnitudes of the torques of the four tendons at the pretension,
    /// N cm. `rate` is the rate of the servo, Hz. Returns None if there is no additional stiffness.
    pub fn new(torques: &Vector3<f64>, numbers: &Numbers, rate: f64) -> Option<Self> {
        (numbers.stiffening > 0.0).then(|| Self {
            most: numbers.stiffening,
            largest: torques * LARGEST,
            held: torques * HELD,
            period: 1.0 / rate,
            rising: (1.0 / (RISING * rate)).min(1.0),
            decay: (-1.0 / (DECAYING * rate)).exp(),
            resting: (1.0 / (RESTING * rate)).min(1.0),
        })
    }

    /// Returns what is added in this cycle. `rates` are the joint rates of the reference, rad/s, and `sprung` is the
    /// joint torque of the spring, N cm. `headroom` is the factor by which the pose permits to scale the stiffness of
    /// the spring.
    pub fn advance(
        &self,
        state: &mut StiffeningState,
        (rates, sprung): (&Vector3<f64>, &Vector3<f64>),
        headroom: f64,
    ) -> Added {
        let rate = rates.amax();
        let change = sprung - state.rest;
        state.staying = if rate >= FAST || (rate >= SLOW && state.staying > 0.0) {
            STAYING
        } else if (0..3).any(|joint| change[joint].abs() > self.held[joint]) {
            0.0
        } else {
            (state.staying - self.period).max(0.0)
        };
        if state.staying > 0.0 {
            state.envelope += (1.0 - state.envelope) * self.rising;
        } else {
            let envelope = state.envelope * self.decay;
            state.envelope = if envelope < ENDED { 0.0 } else { envelope };
        }
        state.rest += change * (self.resting * (1.0 - state.envelope));
        // In this order, a headroom that is NaN gives zero.
        let part = state.envelope * (SUPPORTED * headroom - 1.0).max(0.0).min(self.most);
        let torques = (change * part).zip_map(&self.largest, |torque, largest| torque.clamp(-largest, largest));
        Added { part, torques }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::configuration::ConfiguredController;

    const RATE: f64 = 1000.0;

    /// Runs the law for `time` (s) with a reference of this rate, rad/s, this torque of the spring at joint 0, N cm,
    /// and this headroom.
    fn after(state: &mut StiffeningState, time: f64, (rate, torque, headroom): (f64, f64, f64)) -> Added {
        let tuned = Numbers::new(&ConfiguredController::default(), RATE).expect("usable numbers");
        let numbers = Numbers { stiffening: 1.0, ..tuned };
        let law = Stiffening::new(&Vector3::new(20.0, 20.0, 10.0), &numbers, RATE).expect("additional stiffness");
        let (rates, sprung) = (Vector3::new(0.0, -rate, 0.0), Vector3::new(torque, 0.0, 0.0));
        let cycles = (time * RATE) as usize;
        (0..cycles).map(|_| law.advance(state, (&rates, &sprung), headroom)).last().expect("cycles")
    }

    #[test]
    fn a_fast_motion_makes_the_spring_stiffer_for_a_while() {
        let mut state = StiffeningState::default();
        assert_eq!(after(&mut state, 1.0, (0.0, 0.5, 3.0)).part, 0.0);
        let Added { part, torques } = after(&mut state, 0.1, (4.0, 1.0, 3.0));
        assert!(part > 0.99 && (torques - Vector3::x() * 0.45).amax() < 0.02, "{part} {torques}");
        assert!(after(&mut state, 0.1, (0.0, 1.0, 3.0)).part > 0.99, "{state:?}");
        assert_eq!(after(&mut state, 1.0, (0.0, 1.0, 3.0)).part, 0.0, "{state:?}");
        assert_eq!(after(&mut state, 1.0, (0.39, 1.0, 3.0)).part, 0.0, "a slow motion");
    }

    #[test]
    fn a_finger_that_touches_something_has_the_commanded_stiffness_soon() {
        let mut state = StiffeningState::default();
        assert!(after(&mut state, 0.1, (4.0, 0.0, 3.0)).part > 0.99);
        assert!(after(&mut state, 0.4, (0.0, 2.5, 3.0)).part < 0.01, "{state:?}");
    }

    #[test]
    fn the_pose_and_the_torques_of_the_tendons_limit_what_is_added() {
        for (headroom, expected) in [(1.5, 0.2), (0.9, 0.0), (f64::INFINITY, 1.0), (f64::NAN, 0.0)] {
            let found = after(&mut StiffeningState::default(), 0.2, (4.0, 0.0, headroom)).part;
            assert!((found - expected).abs() < 1e-6, "{headroom}: {found}");
        }
        let torques = after(&mut StiffeningState::default(), 0.1, (4.0, -5.0, 3.0)).torques;
        assert!((torques + Vector3::x() * (LARGEST * 20.0)).amax() < 1e-12, "{torques}");
    }

    #[test]
    fn below_750_hz_the_stiffness_does_not_change() {
        let numbers = |rate| Numbers::new(&ConfiguredController::default(), rate).expect("usable numbers");
        assert!(Stiffening::new(&Vector3::repeat(20.0), &numbers(500.0), 500.0).is_none());
        assert!(Stiffening::new(&Vector3::repeat(20.0), &numbers(RATE), RATE).is_some());
    }
}
