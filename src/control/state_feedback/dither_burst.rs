//! Envelope of the dither of the tensions after a motion of the reference.
//!
//! After a motion, the tensions on the two sides of every pulley differ by the whole friction. A dither whose amplitude
//! is near the friction moves the tendons only at its peaks, so the finger settles slowly. A larger dither that decays
//! over some periods, called a burst, removes this difference, just as a decaying alternating field demagnetises iron.
//! Afterwards the small dither suffices.

use super::full_rate::FULL_RATE;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Rate of the reference, rad/s, from which a motion is fast. A slow motion causes no burst. Otherwise bursts would
/// follow each other, and a grasp that tightens slowly would slip.
pub(super) const FAST: f64 = 0.4;
/// Rate of the reference, rad/s, below which a fast motion has ended.
pub(super) const SLOW: f64 = 0.2;
/// Largest torque of the spring at which a burst begins, as a fraction of the sum of the magnitudes of the torques that
/// the four tendons exert on the joint at the pretension. Pulleys whose friction is this fraction of the tension hold
/// the finger against such a torque. A larger torque usually means that the finger touches something. Without this
/// limit, fingers with rotors of half the inertia moved by 2 mm rms at walls.
const HELD: f64 = 0.1;

/// Time constant with which the envelope rises, s. Directly after a motion the tensions are still low. With 0.01 s, the
/// dither is already large at that time: after a reach of 30 mm, a tension fell to 3.8 N, below t_min of 5 N. With
/// 0.025 s, "worn" and "sheathed" fingers settle later. These names are values of `simulation.hand`.
const RISING: f64 = 0.02;
/// Value from which the envelope counts as risen.
const RISEN: f64 = 0.8;
/// Time for which the envelope stays risen, s. With less, the slowest steps of "worn" fingers settle later. With more,
/// most steps settle later.
const STAYING: f64 = 0.1;
/// Time constant with which the envelope decays, s: some periods of the dither.
const DECAYING: f64 = 0.08;

/// Computes the envelope from the reference and the torque of the spring. The dither itself cannot trigger a burst,
/// because the rates of the reference do not depend on measurements.
#[derive(Clone, Debug)]
pub(super) struct DitherBurst {
    /// Largest torque of the spring at which a burst begins, N cm.
    held: Vector3<f64>,
    /// Whether [`DitherBurst::waits`] is ever true.
    can_wait: bool,
    period: f64,
    rising: f64,
    decay: f64,
}

#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(super) struct DitherBurstState {
    /// From 0 to 1.
    envelope: f64,
    /// Whether there was a fast motion whose burst is still to come.
    awaited: bool,
    /// Time for which the envelope still stays risen, s.
    staying: f64,
}

impl DitherBurst {
    /// `torques` has, for each joint, the sum of the magnitudes of the torques of the four tendons at the pretension,
    /// N cm. `rate` is the rate of the servo, Hz.
    pub fn new(torques: &Vector3<f64>, rate: f64) -> Self {
        Self {
            held: torques * HELD,
            // When `waits` could be true at 500 Hz too, nominal fingers at walls moved by 65 um rms.
            can_wait: rate >= FULL_RATE,
            period: 1.0 / rate,
            rising: (1.0 / (RISING * rate)).min(1.0),
            decay: (-1.0 / (DECAYING * rate)).exp(),
        }
    }

    /// Returns whether the spring has so much torque, N cm, that the finger probably touches something.
    pub fn touches(&self, sprung: &Vector3<f64>) -> bool {
        (0..3).any(|joint| sprung[joint].abs() > self.held[joint])
    }

    /// Returns whether a fast motion has ended and its burst cannot begin: something stopped the finger, or a tendon is
    /// almost slack. `rates` are the joint rates of the reference, rad/s. Call it only while the envelope is small.
    /// While the envelope rises, `awaited` is still true, so the result would be true although the burst has begun.
    pub fn waits(&self, state: &DitherBurstState, rates: &Vector3<f64>) -> bool {
        state.awaited && rates.amax() < SLOW && self.can_wait
    }

    /// Returns the envelope. `rates` are the joint rates of the reference, rad/s. `sprung` is the joint torque of the
    /// spring, N cm. `slack` is true if a tendon is almost slack. In this case the burst ends, because the tensions
    /// must recover first.
    pub fn advance(
        &self,
        state: &mut DitherBurstState,
        rates: &Vector3<f64>,
        sprung: &Vector3<f64>,
        slack: bool,
    ) -> f64 {
        let rate = rates.amax();
        state.awaited |= rate >= FAST;
        let begins = state.awaited && rate < SLOW && !self.touches(sprung);
        if slack {
            (state.envelope, state.staying) = (0.0, 0.0);
        } else if begins || state.staying > 0.0 {
            state.envelope += (1.0 - state.envelope) * self.rising;
            state.staying -= self.period;
            if begins && state.envelope >= RISEN {
                (state.awaited, state.staying) = (false, STAYING);
            }
        } else {
            state.envelope *= self.decay;
        }
        state.envelope
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 1000.0;

    /// Returns the envelope after `time` (s) with a reference of this rate, rad/s, and this torque of joint 2, N cm.
    fn after(state: &mut DitherBurstState, time: f64, rate: f64, torque: f64) -> f64 {
        let burst = DitherBurst::new(&Vector3::new(20.0, 20.0, 10.0), RATE);
        let (rates, sprung) = (Vector3::new(0.0, -rate, 0.0), Vector3::new(0.0, 0.0, -torque));
        (0..(time * RATE) as usize).map(|_| burst.advance(state, &rates, &sprung, false)).last().expect("cycles")
    }

    #[test]
    fn a_fast_motion_causes_one_burst_when_it_ends() {
        let mut state = DitherBurstState::default();
        assert_eq!(after(&mut state, 1.0, 0.0, 0.0), 0.0);
        assert_eq!(after(&mut state, 1.0, 4.0, 0.0), 0.0);
        assert!(after(&mut state, 0.1, 0.1, 0.0) > 0.99, "{state:?}");
        assert!(after(&mut state, 0.1 + DECAYING, 0.0, 0.0) < 0.7, "{state:?}");
        assert!(after(&mut state, 2.0, 0.3, 0.0) < 1e-6, "{state:?}");
    }

    #[test]
    fn slow_motions_cause_no_burst() {
        let mut state = DitherBurstState::default();
        for _ in 0..10 {
            assert_eq!(after(&mut state, 0.5, 0.39, 0.0), 0.0);
            assert_eq!(after(&mut state, 0.5, 0.0, 0.0), 0.0);
        }
    }

    #[test]
    fn a_finger_that_touches_something_has_its_burst_when_it_is_free() {
        let mut state = DitherBurstState::default();
        after(&mut state, 0.1, 4.0, 0.0);
        assert_eq!(after(&mut state, 1.0, 0.0, 1.1), 0.0);
        let burst = DitherBurst::new(&Vector3::repeat(20.0), RATE);
        assert!(burst.waits(&state, &Vector3::zeros()) && !burst.waits(&state, &Vector3::repeat(SLOW)));
        assert!(after(&mut state, 0.1, 0.0, 0.9) > 0.9, "{state:?}");
        assert!(!burst.waits(&state, &Vector3::zeros()), "{state:?}");
    }

    #[test]
    fn the_burst_ends_while_a_tendon_is_almost_slack() {
        let mut state = DitherBurstState { envelope: 0.9, awaited: false, staying: 0.05 };
        let burst = DitherBurst::new(&Vector3::repeat(20.0), RATE);
        assert_eq!(burst.advance(&mut state, &Vector3::zeros(), &Vector3::zeros(), true), 0.0);
        assert_eq!(after(&mut state, 0.1, 0.0, 0.0), 0.0);
    }
}
