//! Envelope of the dither of the tensions after a motion of the reference.
//!
//! A motion leaves every pulley at one end of its friction. A dither whose amplitude is near the friction moves the
//! tendons only at its peaks, so the finger settles slowly. A larger dither that decays over some periods leaves the
//! pulleys without this difference, as an alternating field that decays demagnetises iron. Afterwards the small
//! dither suffices.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Rate of the reference, rad/s, from which the envelope rises to 1.
const SLOW: f64 = 0.05;
/// Rate of the reference, rad/s, above which the envelope does not rise. While the reference is fast, the tendons slide
/// in any case. With a large dither in the fast part of a step, fingers with rotors of half the inertia that hit a hard
/// wall lost the tension of tendons.
const FAST: f64 = 0.4;

/// Time constant with which the envelope rises, s. It is longer than the short time in which a reference that starts is
/// slow.
const RISING: f64 = 0.01;
/// Time constant with which the envelope decays, s: some periods of the dither. With 0.06 s, steps of "sheathed"
/// fingers settled later.
const DECAYING: f64 = 0.12;

/// Computes the envelope from the rate of the reference only. The dither cannot trigger it, because the reference does
/// not depend on measurements.
#[derive(Clone, Debug)]
pub(super) struct DitherBurst {
    rising: f64,
    decay: f64,
}

/// The envelope, from 0 to 1.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(super) struct DitherBurstState(f64);

impl DitherBurst {
    /// `rate` is the rate of the servo, Hz.
    pub fn new(rate: f64) -> Self {
        Self { rising: (1.0 / (RISING * rate)).min(1.0), decay: (-1.0 / (DECAYING * rate)).exp() }
    }

    /// Returns the envelope. `rates` are the joint rates of the reference, rad/s. `slack` is whether a tendon is almost
    /// slack. The envelope is then zero, because the tensions must recover first.
    pub fn advance(&self, state: &mut DitherBurstState, rates: &Vector3<f64>, slack: bool) -> f64 {
        if slack {
            state.0 = 0.0;
            return 0.0;
        }
        let rate = rates.amax();
        let wanted = (rate / SLOW).min(1.0) / (1.0 + (rate / FAST).powi(2));
        let decayed = state.0 * self.decay;
        state.0 = decayed + (wanted - decayed).max(0.0) * self.rising;
        state.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE: f64 = 1000.0;

    /// Returns the envelope after `cycles` cycles with a reference of this rate, rad/s.
    fn after(state: &mut DitherBurstState, cycles: usize, rate: f64) -> f64 {
        let burst = DitherBurst::new(RATE);
        (0..cycles).map(|_| burst.advance(state, &Vector3::new(0.0, -rate, 0.0), false)).last().expect("cycles")
    }

    #[test]
    fn the_envelope_rises_at_the_slow_end_of_a_motion_and_decays_at_rest() {
        let mut state = DitherBurstState::default();
        assert_eq!(after(&mut state, 1000, 0.0), 0.0);
        assert!(after(&mut state, 60, 4.0) < 0.02, "{state:?}");
        assert!(after(&mut state, 30, 0.1) > 0.8, "{state:?}");
        let risen = state.0;
        let decayed = after(&mut state, 120, 0.0);
        assert!((decayed / risen - (-1.0f64).exp()).abs() < 1e-9, "{decayed} of {risen}");
        assert!(after(&mut state, 2000, 0.0) < 1e-6);
    }

    #[test]
    fn the_envelope_ends_while_a_tendon_is_almost_slack() {
        let mut state = DitherBurstState(0.9);
        assert_eq!(DitherBurst::new(RATE).advance(&mut state, &Vector3::repeat(0.1), true), 0.0);
        assert_eq!(state.0, 0.0);
    }
}
