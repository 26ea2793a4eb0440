//! Turns set points that arrive at a low rate into a smooth motion.
//!
//! Each new set point adds a smooth step to the motion, and the steps overlap. The rate of a step is a quadratic
//! B-spline, whose three parts each last as long as a period of the planner. The sum of the steps is therefore
//! continuous up to its acceleration. Set points that come once in each period and are equally far apart give a
//! constant rate. Nothing overshoots: the sum stays between the set points that were sent. The price is a delay of one
//! and a half periods of the planner.
//!
//! A polynomial that reaches each new set point at an estimated rate would have a smaller delay. It was rejected,
//! because it overshoots the last set point when a planner stops sending.

use crate::control::motion::Motion;
use crate::control::spring::slew::Slew;
use nalgebra::Vector3;

/// Least period of the planner, s. This period replaces a shorter one. The acceleration and the jerk of a step are fed
/// forward. If a far step were completed within a few milliseconds, they would demand more than the largest tension.
const LEAST_TIME: f64 = 0.01;

/// Smallest time between the starts of two steps, as a fraction of the planner's period. Set points that come faster
/// are combined.
const SPACING: f64 = 0.25;

/// Largest number of steps that overlap. A step lasts for three periods of the planner, and [`SPACING`] keeps the steps
/// apart.
const MOST_STEPS: usize = 13;

/// The constant part of the interpolation.
#[derive(Clone, Debug)]
pub struct Interpolation {
    /// Period of the servo, s.
    period: f64,
    /// Period of the planner, s, at least [`LEAST_TIME`].
    time: f64,
    /// Smallest time between the starts of two steps, cycles.
    spacing: u32,
    /// Limit of the joint rates, rad/s.
    speed: f64,
    /// Limits a step to the distance that the speed limit of set points permits.
    slew: Slew,
}

/// The steps that have not ended.
#[derive(Clone, Copy, Debug, Default)]
pub struct InterpolationState {
    /// Set point before the steps, rad.
    base: Vector3<f64>,
    /// Set point after the steps, rad.
    admitted: Vector3<f64>,
    steps: [Step; MOST_STEPS],
    count: usize,
    /// Cycles until the next step may begin.
    wait: u32,
}

#[derive(Clone, Copy, Debug, Default)]
struct Step {
    way: Vector3<f64>,
    /// Length of each third of the step, s. It is the period of the planner when the step began, or longer (see
    /// [`Interpolation::time_of_new_step`]). The step keeps it, so that a change of the period does not move the set
    /// point.
    time: f64,
    /// Time since the step began, s.
    age: f64,
}

impl Interpolation {
    /// Constructs the interpolation for a planner that sends a set point every `time` s. `speed` is the limit of the
    /// joint rates, rad/s, and `rate` is in Hz.
    pub fn new(time: f64, speed: f64, rate: f64) -> Self {
        let time = time.max(LEAST_TIME);
        // Rounding up keeps the number of steps that overlap below `MOST_STEPS`.
        let spacing = (time * rate * SPACING).ceil().max(1.0);
        Self { period: 1.0 / rate, time, spacing: spacing as u32, speed, slew: Slew::new(speed, rate / spacing) }
    }

    /// Advances by one cycle toward `target`, rad. Returns the joint angles, and their motion unless they rest.
    pub fn advance(&self, state: &mut InterpolationState, target: &Vector3<f64>) -> (Vector3<f64>, Option<Motion>) {
        state.wait = state.wait.saturating_sub(1);
        if state.wait == 0 && state.admitted != *target && state.count < MOST_STEPS {
            let before = state.admitted;
            self.slew.advance(&mut state.admitted, target);
            let share = self.share(state);
            if share < 1.0 {
                state.admitted = before + (state.admitted - before) * share;
            }
            if share > 0.0 {
                let time = self.time_of_new_step(state);
                state.steps[state.count] = Step { way: state.admitted - before, time, age: 0.0 };
                state.count += 1;
                state.wait = self.spacing;
            }
        }
        if state.count == 0 {
            return (state.admitted, None);
        }
        let (mut joints, mut motion) = (state.base, Motion::default());
        let mut kept = 0;
        for index in 0..state.count {
            let mut step = state.steps[index];
            step.age += self.period;
            let part = step.age / step.time;
            let [place, rate, acceleration, jerk] = smooth_step(part);
            joints += step.way * place;
            motion.rates += step.way * (rate / step.time);
            motion.accelerations += step.way * (acceleration / step.time.powi(2));
            motion.jerk += step.way * (jerk / step.time.powi(3));
            if part >= 3.0 {
                state.base += step.way;
            } else {
                state.steps[kept] = step;
                kept += 1;
            }
        }
        state.count = kept;
        if state.count == 0 {
            // Rounding errors of the sum must not accumulate.
            state.base = state.admitted;
        }
        (joints, Some(motion))
    }

    /// Returns the period with which a new step does not end before the running steps. After the planner's period
    /// became shorter, a step with the new period would overtake an older step. If the two had opposite directions, the
    /// sum would leave the range of the set points that were sent.
    fn time_of_new_step(&self, state: &InterpolationState) -> f64 {
        state.steps[..state.count].iter().map(|step| step.time - step.age / 3.0).fold(self.time, f64::max)
    }

    /// Returns the share of the speed limit that a new step may use, 0 to 1. It is below 1 only while steps with
    /// another period of the planner run. The rest of the limit is for these steps.
    fn share(&self, state: &InterpolationState) -> f64 {
        let others = state.steps[..state.count].iter().filter(|step| step.time != self.time);
        // The largest rate of a step is three quarters of its way per period of the planner.
        let fastest: f64 = others.map(|step| 0.75 * step.way.amax() / step.time).sum();
        (1.0 - fastest / self.speed).max(0.0)
    }
}

impl InterpolationState {
    /// Returns the state of a set point that rests at `joints`, rad.
    pub fn at_rest(joints: Vector3<f64>) -> Self {
        Self { base: joints, admitted: joints, ..Self::default() }
    }

    /// Returns the state of a set point that stops at `joints`, rad, because its path is replaced. The first step
    /// begins a cycle later, so that the set point rests for one cycle. State feedback then treats the difference
    /// between its reference and the new motion as a deviation, which its filter reduces to zero. Without this cycle,
    /// the reference would follow the jump of the rates.
    pub fn stopped(joints: Vector3<f64>) -> Self {
        Self { wait: 2, ..Self::at_rest(joints) }
    }
}

/// Returns a step from 0 to 1 and its first three derivatives. `time` is 0 to 3, in periods of the planner.
fn smooth_step(time: f64) -> [f64; 4] {
    let left = 3.0 - time;
    if time < 1.0 {
        [time.powi(3) / 6.0, 0.5 * time.powi(2), time, 1.0]
    } else if time < 2.0 {
        let rate = (3.0 - time) * time - 1.5;
        [0.5 - ((time / 3.0 - 1.5) * time + 1.5) * time, rate, 3.0 - 2.0 * time, -2.0]
    } else if left > 0.0 {
        [1.0 - left.powi(3) / 6.0, 0.5 * left.powi(2), -left, 1.0]
    } else {
        [1.0, 0.0, 0.0, 0.0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const RATE: f64 = 1000.0;

    /// Runs the interpolation of a planner with a period of 0.1 s. `send` returns the set point of each cycle.
    fn run(cycles: u32, send: impl Fn(u32) -> Vector3<f64>) -> Vec<(Vector3<f64>, Motion)> {
        let interpolation = Interpolation::new(0.1, 5.0, RATE);
        let mut state = InterpolationState::at_rest(Vector3::zeros());
        let next = |cycle| {
            let (joints, motion) = interpolation.advance(&mut state, &send(cycle));
            (joints, motion.unwrap_or_default())
        };
        (0..cycles).map(next).collect()
    }

    #[test]
    fn equal_steps_give_a_constant_rate() {
        let all = run(2000, |cycle| Vector3::x() * (f64::from(cycle / 100) * 0.05));
        assert!(all[400..].iter().all(|(_, motion)| (motion.rates.x - 0.5).abs() < 1e-9));
        // The delay is one and a half periods, plus half a period because a set point is half a period old on average.
        assert!((all[1499].0.x - 0.5 * (1.5 - 0.15 - 0.05)).abs() < 1e-3, "{}", all[1499].0.x);
    }

    #[test]
    fn a_far_step_keeps_to_the_speed_limit() {
        let target = Vector3::new(1.0, -2.0, 0.0);
        let all = run(1500, |_| target);
        assert!(all.iter().all(|(_, motion)| motion.rates.amax() < 5.0 * (1.0 + 1e-9)));
        assert!((all[1499].0 - target).amax() < 1e-12 && all[1499].1 == Motion::default());
    }

    #[test]
    fn a_short_period_neither_demands_a_large_acceleration_nor_falls_behind() {
        for period in [0.001, 0.002, 0.005] {
            let interpolation = Interpolation::new(period, 5.0, RATE);
            let mut state = InterpolationState::at_rest(Vector3::zeros());
            for _ in 0..200 {
                let (_, motion) = interpolation.advance(&mut state, &(Vector3::x() * 0.3));
                // The limit is three quarters of the speed limit per least period, plus a small ripple.
                let acceleration = motion.unwrap_or_default().accelerations.amax();
                assert!(acceleration < 400.0, "{period}: {acceleration} rad/s^2");
            }
            let mut state = InterpolationState::at_rest(Vector3::zeros());
            for cycle in 0..2000 {
                let sent = f64::from(cycle) / RATE;
                let (joints, _) = interpolation.advance(&mut state, &(Vector3::x() * sent));
                assert!(sent - joints.x < 0.02, "{period} {cycle}: {}", joints.x);
            }
        }
    }

    #[test]
    fn a_change_of_the_period_neither_moves_the_set_point_nor_exceeds_the_speed_limit() {
        for (period, new_period) in [(0.1, 0.01), (0.1, 0.05), (0.01, 1.0), (1.0, 0.01)] {
            for distance in [0.1, 2.0] {
                let mut interpolation = Interpolation::new(period, 5.0, RATE);
                let mut state = InterpolationState::at_rest(Vector3::zeros());
                let (mut last, target) = (0.0, Vector3::x() * distance);
                for cycle in 0..6000 {
                    if cycle == 20 {
                        interpolation = Interpolation::new(new_period, 5.0, RATE);
                    }
                    let (joints, motion) = interpolation.advance(&mut state, &target);
                    // The spacing of the steps is a whole number of cycles, which causes a small ripple.
                    assert!((joints.x - last) * RATE < 5.01, "{period} {new_period} {cycle}");
                    assert!(joints.x > last - 1e-12 && motion.unwrap_or_default().rates.amax() < 5.01);
                    last = joints.x;
                }
                assert!((last - distance).abs() < 1e-12, "{period} {new_period}");
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

        #[test]
        fn a_change_of_the_period_keeps_the_motion_within_its_set_points(
            places in prop::collection::vec(-1.0..1.0f64, 1..4), every in 1u32..150,
            periods in (-1.0..0.0f64, -2.0..0.0f64), changed in 0u32..450,
        ) {
            let interpolations = [periods.0, periods.1].map(|power| Interpolation::new(10f64.powf(power), 5.0, RATE));
            let mut state = InterpolationState::at_rest(Vector3::zeros());
            let least = places.iter().copied().fold(0.0, f64::min);
            let most = places.iter().copied().fold(0.0, f64::max);
            let (last, mut end) = (places[places.len() - 1], 0.0);
            // Steps with the old period take up to 3 s, and so does the last step after them.
            for cycle in 0..changed.max(4 * every) + 7000 {
                let place = places[places.len().min((cycle / every) as usize + 1) - 1];
                let interpolation = &interpolations[usize::from(cycle >= changed)];
                let (joints, _) = interpolation.advance(&mut state, &(Vector3::x() * place));
                prop_assert!((least - 1e-9..=most + 1e-9).contains(&joints.x), "{}", joints.x);
                end = joints.x;
            }
            prop_assert!((end - last).abs() < 1e-9, "{end} instead of {last}");
        }

        #[test]
        fn any_stream_is_smooth_and_stays_within_its_set_points(
            places in prop::collection::vec(-1.0..1.0f64, 1..40), every in 1u32..150,
        ) {
            let send = |cycle: u32| {
                let index = (cycle / every) as usize;
                Vector3::x() * places[index.min(places.len() - 1)]
            };
            let all = run(40 * every + 2000, send);
            let most = places.iter().fold(0.0f64, |most, place| most.max(place.abs()));
            for pair in all.windows(2) {
                let [(before, motion), (after, next)] = pair else { unreachable!("pairs") };
                prop_assert!(after.x.abs() <= most + 1e-9);
                let rate = (after.x - before.x) * RATE;
                prop_assert!((rate - 0.5 * (motion.rates.x + next.rates.x)).abs() < 0.01);
                let acceleration = (next.rates.x - motion.rates.x) * RATE;
                let expected = 0.5 * (motion.accelerations.x + next.accelerations.x);
                prop_assert!((acceleration - expected).abs() < 5.0, "{acceleration} {expected}");
                prop_assert!((next.accelerations.x - motion.accelerations.x).abs() < 50.0);
            }
            prop_assert!((all[all.len() - 1].0.x - places[places.len() - 1]).abs() < 1e-9);
        }
    }
}
