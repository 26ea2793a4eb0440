//! Continuations of the reference: with another time constant, and along another path.

use super::{Reference, ReferenceMotion, ReferenceState};
use crate::control::motion::Motion;
use nalgebra::Vector3;

impl Reference {
    /// Converts the stages of `previous`, a filter with another time constant, so that the reference keeps its motion.
    /// The parameters are those of [`Reference::advance_along`].
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
        let ahead = *anchor - state.0[0];
        *state = converted(state);
        *along = along.as_ref().map(converted);
        // The first stage keeps its rate, too. With a longer time constant, the anchor must be farther ahead of the
        // first stage for this rate. It could then be beyond a set point at rest. So the anchor stays in this case, and
        // the reference slows down.
        if longer < 1.0 || along.is_some() {
            *anchor = state.0[0] + ahead * longer;
        }
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

    /// The speed of the anchor is 5 rad/s. The adjustment comes while the reference speeds up, while it has its full
    /// speed, and while it slows down.
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
            // A cycle is as long as the time constant of a filter of 1 ms, so the motion changes a lot within a cycle.
            let most = if time < 0.002 { [1.5, 1500.0] } else { [0.3, 100.0] };
            assert!(rates < most[0] && accelerations < most[1], "{time} {cycles}: {rates} {accelerations}");
            let fastest = all.iter().fold(0.0f64, |fastest, motion| fastest.max(motion.rates.amax()));
            assert!(fastest < 5.3, "{time} {cycles}: {fastest}");
            assert!((all[799].joints - Vector3::x()).amax() < 1e-3, "{time} {cycles}");
        }
    }

    /// A path that arrives late is 0.02 rad away from the path that it replaces.
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
