//! The reference of the joints, and its derivatives. The controller feeds the derivatives forward. A set point in
//! motion has its own derivatives. A set point at rest has none, so it is filtered.

mod continuation;

use crate::control::motion::Motion;
use crate::control::spring::slew::Slew;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Number of poles of the filter.
const ORDER: usize = 5;

/// Five equal first-order stages in series. The motor torque of an elastic finger depends on the fourth derivative of
/// the reference (snap). A filter of order n makes the derivative n - 1 continuous.
///
/// The filter acts on joint angles and not on the tip. So the joint rates are computed without J^-1, which is
/// unbounded.
#[derive(Clone, Debug)]
pub(crate) struct Reference {
    /// Fraction of the remaining difference by which a stage moves in a cycle.
    gain: f64,
    /// The input of a stage minus its output, divided by the slope of the output from the last cycle to this one, s.
    /// `lag` is smaller than the time constant of a stage by about half a cycle, because the filter advances in steps.
    lag: f64,
    /// 1 / `lag` to the powers 1 to 4.
    per: [f64; 4],
}

/// Outputs of the stages, rad.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(crate) struct ReferenceState([Vector3<f64>; ORDER]);

impl ReferenceState {
    /// Returns the outputs of the stages of a filter whose last output has the given motion.
    fn of(joints: &Vector3<f64>, motion: &Motion, lag: f64) -> Self {
        // The input of a stage is its output plus `lag` times the rate of its output. The last stage has the joint
        // angles as its output. So the output of the stage n places before it is (1 + lag d/dt)^n applied to the joint
        // angles.
        let Motion { rates, accelerations, jerk, snap } = motion;
        let (one, two, three, four) =
            (rates * lag, accelerations * lag.powi(2), jerk * lag.powi(3), snap * lag.powi(4));
        Self([
            joints + one * 4.0 + two * 6.0 + three * 4.0 + four,
            joints + one * 3.0 + two * 3.0 + three,
            joints + one * 2.0 + two,
            joints + one,
            *joints,
        ])
    }

    fn combine(&self, other: &Self, sum: impl Fn(&Vector3<f64>, &Vector3<f64>) -> Vector3<f64>) -> Self {
        Self(std::array::from_fn(|stage| sum(&self.0[stage], &other.0[stage])))
    }
}

/// Joint angles, rad, and their first four derivatives, rad/s^n.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReferenceMotion {
    pub joints: Vector3<f64>,
    pub rates: Vector3<f64>,
    pub accelerations: Vector3<f64>,
    pub jerk: Vector3<f64>,
    pub snap: Vector3<f64>,
}

impl Reference {
    /// Constructs the filter from the time constant of each stage, s, and the rate, Hz.
    pub fn new(time: f64, rate: f64) -> Self {
        let cycles = 1.0 / (time * rate);
        let lag = 1.0 / (rate * cycles.exp_m1());
        let per = 1.0 / lag;
        Self { gain: -(-cycles).exp_m1(), lag, per: [per, per.powi(2), per.powi(3), per.powi(4)] }
    }

    /// Returns the state of a reference at rest.
    pub fn start(&self, joints: &Vector3<f64>) -> ReferenceState {
        ReferenceState([*joints; ORDER])
    }

    /// Advances the reference by one cycle toward `target`, rad.
    pub fn advance(&self, state: &mut ReferenceState, target: &Vector3<f64>) -> ReferenceMotion {
        let mut input = *target;
        for stage in &mut state.0 {
            *stage += (input - *stage) * self.gain;
            input = *stage;
        }
        self.motion(state)
    }

    /// Advances the reference by one cycle with a set point that has its own motion. The reference is the set point
    /// plus a deviation. There is a deviation if the reference was elsewhere before. The filter reduces the deviation
    /// to zero, so that the reference stays continuous up to its snap. A large deviation first shrinks at the speed of
    /// `slew`.
    ///
    /// `anchor` is the input of the filter. `along` has the outputs that the stages would have if the reference
    /// equalled the set point of the last cycle. It is `None` if that set point was at rest.
    pub fn advance_along(
        &self,
        state: &mut ReferenceState,
        anchor: &mut Vector3<f64>,
        along: &mut Option<ReferenceState>,
        slew: &Slew,
        (joints, motion): (&Vector3<f64>, &Motion),
    ) -> ReferenceMotion {
        let next = ReferenceState::of(joints, motion, self.lag);
        let (mut deviation, mut input) = match along {
            Some(last) => (state.combine(last, |stage, last| stage - last), *anchor - last.0[0]),
            None => {
                self.advance(state, anchor);
                (state.combine(&next, |stage, next| stage - next), *anchor - next.0[0])
            }
        };
        slew.advance(&mut input, &Vector3::zeros());
        if along.is_some() {
            self.advance(&mut deviation, &input);
        }
        let off = self.motion(&deviation);
        *state = next.combine(&deviation, |next, deviation| next + deviation);
        *anchor = next.0[0] + input;
        *along = Some(next);
        ReferenceMotion {
            joints: joints + off.joints,
            rates: motion.rates + off.rates,
            accelerations: motion.accelerations + off.accelerations,
            jerk: motion.jerk + off.jerk,
            snap: motion.snap + off.snap,
        }
    }

    /// Returns the motion of the last stage. Each derivative follows from x_n' = (x_(n-1) - x_n) / `lag`, so the rates
    /// are the slopes of the angles from cycle to cycle. With the time constant in place of `lag`, the rates would be
    /// too small.
    pub fn motion(&self, state: &ReferenceState) -> ReferenceMotion {
        let [first, second, third, fourth, last] = state.0;
        let [per, per_2, per_3, per_4] = self.per;
        ReferenceMotion {
            joints: last,
            rates: (fourth - last) * per,
            accelerations: (third - fourth * 2.0 + last) * per_2,
            jerk: (second - third * 3.0 + fourth * 3.0 - last) * per_3,
            snap: (first - second * 4.0 + third * 6.0 - fourth * 4.0 + last) * per_4,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    pub(crate) const RATE: f64 = 1000.0;

    /// Returns joint angles and motion of a path: a sine in joint 0 with the amplitude 0.3 rad and the angular
    /// frequency 8 rad/s.
    pub(crate) fn path(seconds: f64) -> (Vector3<f64>, Motion) {
        let wave = |derivative: i32| {
            Vector3::x() * (0.3 * 8f64.powi(derivative) * (8.0 * seconds + f64::from(derivative) * FRAC_PI_2).sin())
        };
        (wave(0), Motion { rates: wave(1), accelerations: wave(2), jerk: wave(3), snap: wave(4) })
    }

    /// Runs a reference whose set point is at rest, then moves along the path for 0.3 s, and then is at rest again. The
    /// reference starts `offset`, rad, away from the beginning of the path.
    fn run(offset: f64) -> Vec<ReferenceMotion> {
        let (filter, slew) = (Reference::new(0.008, RATE), Slew::new(5.0, RATE));
        let (mut anchor, mut along) = (Vector3::x() * offset, None);
        let mut state = filter.start(&anchor);
        let mut all = Vec::new();
        for cycle in 0..700 {
            all.push(match cycle {
                100..400 => {
                    let (joints, motion) = path(f64::from(cycle - 100) / RATE);
                    filter.advance_along(&mut state, &mut anchor, &mut along, &slew, (&joints, &motion))
                }
                _ => {
                    along = None;
                    slew.advance(&mut anchor, &Vector3::zeros());
                    filter.advance(&mut state, &anchor)
                }
            });
        }
        all
    }

    #[test]
    fn the_rates_are_the_slopes_of_the_angles() {
        let (filter, slew) = (Reference::new(0.008, RATE), Slew::new(5.0, RATE));
        let mut anchor = Vector3::zeros();
        let mut state = filter.start(&anchor);
        let mut last = anchor;
        for _ in 0..300 {
            slew.advance(&mut anchor, &Vector3::x());
            let motion = filter.advance(&mut state, &anchor);
            let slope = (motion.joints - last) * RATE;
            assert!((motion.rates - slope).amax() < 1e-9, "{} and {slope}", motion.rates);
            last = motion.joints;
        }
    }

    #[test]
    fn a_set_point_with_motion_is_followed_without_lag_and_without_jumps() {
        for offset in [0.0, 0.01, -0.4] {
            let all = run(offset);
            let (joints, motion) = path(0.299);
            assert!((all[399].joints - joints).amax() < 1e-4 && (all[399].rates - motion.rates).amax() < 1e-2);
            // The path begins and ends at a speed of up to 2.4 rad/s. A jump of the rate by 0.02 rad/s would be a jerk
            // of 20 000 rad/s^3.
            let differences =
                |values: Vec<f64>| -> Vec<f64> { values.windows(2).map(|pair| (pair[1] - pair[0]) * RATE).collect() };
            let mut values: Vec<f64> = all.iter().map(|motion| motion.joints.x).collect();
            for most in [6.0, 180.0, 15_000.0] {
                values = differences(values);
                let largest = values.iter().fold(0.0f64, |largest, value| largest.max(value.abs()));
                assert!(largest < most, "{offset}: {largest}");
            }
        }
    }
}
