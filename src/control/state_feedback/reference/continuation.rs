//! Keeps the reference continuous when the time constant of its filter changes, or when another path replaces the path
//! that it follows.

use super::{ORDER, Reference, ReferenceMotion, ReferenceState};
use crate::control::motion::Motion;
use nalgebra::Vector3;

/// Largest distance of the output of a stage from the output of the last stage after the time constant has become
/// longer, in multiples of the largest such distance before the change. At full speed, a change of the time constant
/// from 0.008 s to 0.02 s does not reach this bound.
const STRETCH: f64 = 3.0;

impl Reference {
    /// Converts the stages of `previous`, a filter with another time constant, so that the reference keeps its motion.
    /// The parameters are those of [`Reference::advance_along`].
    ///
    /// A filter with a much longer time constant would continue the acceleration of a fast filter for so long that the
    /// reference would run far past the set point. So the conversion bounds the first stages. The reference then keeps
    /// only its place and its rates.
    pub fn take_over(
        &self,
        previous: &Self,
        state: &mut ReferenceState,
        anchor: &mut Vector3<f64>,
        along: &mut Option<ReferenceState>,
    ) {
        let longer = self.lag / previous.lag;
        if longer == 1.0 {
            // The conversion would only round the stages.
            return;
        }
        let converted = |state: &ReferenceState| {
            let ReferenceMotion { joints, rates, accelerations, jerk, snap } = previous.motion(state);
            ReferenceState::of(&joints, &Motion { rates, accelerations, jerk, snap }, self.lag)
        };
        // A set point that moves keeps its motion. The conversion may change only the motion of the deviation, which is
        // the reference minus this set point.
        let moved = along.unwrap_or_default();
        let deviation = state.combine(&moved, |stage, moved| stage - moved);
        let mut input = *anchor - moved.0[0];
        let (moved, mut next) = (converted(&moved), converted(&deviation));
        if longer > 1.0 {
            // To keep the rate of the first stage, the input would have to be farther ahead of this stage. The input
            // could then be beyond a set point at rest. So the input is not changed, and the reference slows down.
            next.limit(&deviation, &input);
        } else {
            // With this input, the first stage also keeps its rate.
            input = next.0[0] + (input - deviation.0[0]) * longer;
        }
        *anchor = moved.0[0] + input;
        *state = moved.combine(&next, |moved, next| moved + next);
        *along = along.map(|_| moved);
    }

    /// Makes the reference follow the motion of another set point, which now has the angles `joints` and the motion
    /// `motion`. `along` is as in [`Reference::advance_along`]. The difference between the two set points thus becomes
    /// a deviation, which passes through the filter.
    pub fn replace_along(
        &self,
        along: &mut Option<ReferenceState>,
        joints: &Vector3<f64>,
        motion: &Motion,
        period: f64,
    ) {
        if along.is_some() {
            let (joints, motion) = before(joints, motion, period);
            *along = Some(ReferenceState::of(&joints, &motion, self.lag));
        }
    }
}

impl ReferenceState {
    /// Bounds the distance of each output from the last output, in each direction, to [`STRETCH`] times the largest
    /// such distance of the stages `before` and of their `input`. The last two outputs are not changed, because they
    /// determine the place and the rates.
    fn limit(&mut self, before: &Self, input: &Vector3<f64>) {
        let joints = before.0[ORDER - 1];
        let (mut low, mut high) = (Vector3::zeros(), Vector3::zeros());
        for value in before.0.iter().chain([input]) {
            let ahead = value - joints;
            (low, high) = (ahead.inf(&low), ahead.sup(&high));
        }
        let (low, high) = (joints + low * STRETCH, joints + high * STRETCH);
        for stage in &mut self.0[..ORDER - 2] {
            *stage = stage.sup(&low).inf(&high);
        }
    }
}

/// Returns the joint angles and the motion that a set point had one period earlier. `period` is in s. The snap is
/// considered constant.
fn before(joints: &Vector3<f64>, motion: &Motion, period: f64) -> (Vector3<f64>, Motion) {
    let Motion { rates, accelerations, jerk, snap } = *motion;
    let [one, two, three, four] = [period, period.powi(2) / 2.0, period.powi(3) / 6.0, period.powi(4) / 24.0];
    let earlier = Motion {
        rates: rates - accelerations * one + jerk * two - snap * three,
        accelerations: accelerations - jerk * one + snap * two,
        jerk: jerk - snap * one,
        snap,
    };
    (joints - rates * one + accelerations * two - jerk * three + snap * four, earlier)
}

#[cfg(test)]
mod tests {
    use super::super::tests::{RATE, path};
    use super::*;
    use crate::control::spring::slew::Slew;

    /// Returns the largest difference between the slope of the reference and its rates, rad/s, and between the slope
    /// of the rates and the accelerations, rad/s^2.
    fn largest_jumps(all: &[ReferenceMotion]) -> [f64; 2] {
        all.windows(2).fold([0.0f64; 2], |[rates, accelerations], pair| {
            let (one, next) = (&pair[0], &pair[1]);
            let rate = (next.joints - one.joints) * RATE - (one.rates + next.rates) * 0.5;
            let acceleration = (next.rates - one.rates) * RATE - (one.accelerations + next.accelerations) * 0.5;
            [rates.max(rate.amax()), accelerations.max(acceleration.amax())]
        })
    }

    /// The speed of the anchor is 5 rad/s. The time constant changes while the reference speeds up, while it has its
    /// full speed, or while it slows down.
    #[test]
    fn another_time_constant_does_not_move_a_reference_on_its_way() {
        let (first, slew) = (Reference::new(0.008, RATE), Slew::new(5.0, RATE));
        for (time, cycles) in [0.001, 0.004, 0.02].into_iter().flat_map(|time| [20, 80, 210].map(|at| (time, at))) {
            let second = Reference::new(time, RATE);
            let (mut anchor, mut along) = (Vector3::zeros(), None);
            let mut state = first.start(&anchor);
            let mut all = Vec::new();
            for cycle in 0..800 {
                let filter = if cycle < cycles { &first } else { &second };
                if cycle == cycles {
                    second.take_over(&first, &mut state, &mut anchor, &mut along);
                }
                slew.advance(&mut anchor, &Vector3::x());
                filter.advance(&mut state, &anchor);
                all.push(filter.motion(&state));
            }
            let [rates, accelerations] = largest_jumps(&all);
            // The time constant of 1 ms is as long as a cycle, so the motion changes a lot within a cycle.
            let most = if time < 0.002 { [1.5, 1500.0] } else { [0.3, 100.0] };
            assert!(rates < most[0] && accelerations < most[1], "{time} {cycles}: {rates} {accelerations}");
            let fastest = all.iter().fold(0.0f64, |fastest, motion| fastest.max(motion.rates.amax()));
            assert!(fastest < 5.3, "{time} {cycles}: {fastest}");
            assert!((all[799].joints - Vector3::x()).amax() < 1e-3, "{time} {cycles}");
        }
    }

    /// Runs a reference toward 0.3 rad. The time constants `times`, s, follow each other, the second from cycle `at` on
    /// and each later one `gap` cycles after its predecessor.
    fn with_time_constants(times: &[f64], at: usize, gap: usize) -> Vec<ReferenceMotion> {
        let (goal, slew) = (Vector3::x() * 0.3, Slew::new(5.0, RATE));
        let (mut anchor, mut along) = (Vector3::zeros(), None);
        let mut filter = Reference::new(times[0], RATE);
        let mut state = filter.start(&anchor);
        let mut all = Vec::new();
        for cycle in 0..1000 {
            if let Some(place) = (1..times.len()).find(|place| cycle == at + gap * (place - 1)) {
                let next = Reference::new(times[place], RATE);
                next.take_over(&filter, &mut state, &mut anchor, &mut along);
                filter = next;
            }
            slew.advance(&mut anchor, &goal);
            all.push(filter.advance(&mut state, &anchor));
        }
        all
    }

    /// Two adjustments shortly after each other can make the time constant twenty times as long.
    #[test]
    fn a_much_longer_time_constant_does_not_carry_the_reference_past_its_set_point() {
        let cases: [(&[f64], usize); 3] =
            [(&[0.001, 0.02], 1), (&[0.008, 0.001, 0.02], 5), (&[0.001, 0.003, 0.009, 0.02], 20)];
        for (times, gap) in cases {
            for at in (1..120).step_by(7) {
                let all = with_time_constants(times, at, gap);
                let fastest = all.iter().fold(0.0f64, |fastest, motion| fastest.max(motion.rates.amax()));
                let farthest = all.iter().fold(0.0f64, |farthest, motion| farthest.max(motion.joints.x));
                assert!(fastest < 5.01 && farthest < 0.35, "{times:?} {at}: {fastest} rad/s, {farthest} rad");
                assert!((all[999].joints.x - 0.3).abs() < 1e-6, "{times:?} {at}");
            }
        }
    }

    /// The reference begins 0.4 rad away from the path. The time constant changes on the way to the path.
    #[test]
    fn a_much_longer_time_constant_does_not_disturb_a_path() {
        let (first, second, slew) = (Reference::new(0.001, RATE), Reference::new(0.02, RATE), Slew::new(5.0, RATE));
        for at in (1..200).step_by(9) {
            let (mut anchor, mut along) = (Vector3::x() * -0.4, None);
            let mut state = first.start(&anchor);
            let mut deviation = Vector3::zeros();
            for cycle in 0..1000 {
                let (joints, motion) = path(f64::from(cycle) / RATE);
                let filter = if cycle < at { &first } else { &second };
                if cycle == at {
                    second.take_over(&first, &mut state, &mut anchor, &mut along);
                }
                let followed = filter.advance_along(&mut state, &mut anchor, &mut along, &slew, (&joints, &motion));
                deviation = followed.joints - joints;
                let faster = (followed.rates - motion.rates).amax();
                assert!(deviation.x < 0.05 && faster < 5.01, "{at} {cycle}: {deviation} rad, {faster} rad/s");
            }
            assert!(deviation.amax() < 1e-6, "{at}: {deviation}");
        }
    }

    /// The new path is 0.02 rad away from the path that it replaces, like a path that arrives late.
    #[test]
    fn a_path_that_replaces_another_one_is_reached_through_the_filter() {
        let (filter, slew) = (Reference::new(0.008, RATE), Slew::new(5.0, RATE));
        let (mut state, mut along) = (filter.start(&Vector3::zeros()), None);
        let mut anchor = Vector3::zeros();
        let mut all = Vec::new();
        for cycle in 0..400 {
            let (mut joints, motion) = path(f64::from(cycle) / RATE);
            if cycle >= 200 {
                joints.x += 0.02;
            }
            if cycle == 200 {
                filter.replace_along(&mut along, &joints, &motion, 1.0 / RATE);
            }
            all.push(filter.advance_along(&mut state, &mut anchor, &mut along, &slew, (&joints, &motion)));
        }
        let [rates, accelerations] = largest_jumps(&all[150..]);
        assert!(rates < 0.3 && accelerations < 40.0, "{rates} {accelerations}");
        let (joints, _) = path(0.399);
        assert!((all[399].joints.x - joints.x - 0.02).abs() < 1e-4);
    }
}
