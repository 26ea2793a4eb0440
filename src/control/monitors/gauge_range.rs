//! Detects gauges at the end of their range, and tendons with too much tension.

use super::alarm::{Alarm, Symptom, first_of};
use super::gauge_ends::GaugeEnds;
use super::sample::Sample;
use crate::model::Part;
use crate::model::configuration::ConfiguredFinger;

/// Largest tolerated tension divided by t_max. Commands stay below t_max, but after impacts and steps the tension
/// overshoots.
const OVERSHOOT: f64 = 1.3;

/// A gauge that shows less than minus this fraction of t_min is defective.
const BELOW_ZERO: f64 = 0.5;

/// If a gauge reaches the end of its range from a tension above this fraction of t_max, its tendon has too much
/// tension. If it reaches the end from a lower tension, it has jumped there and is defective.
const PULLED: f64 = 0.5;

/// A gauge that is out of range, or a tension that is too large, raises an alarm after this time, s.
const DURATION: f64 = 0.004;

#[derive(Clone, Debug)]
pub(super) struct GaugeRange {
    ends: GaugeEnds,
    /// If a gauge showed more than this tension, N, before it reached the end of its range, its tendon has pulled it
    /// there.
    pulled: f64,
    /// Largest tolerated tension, N.
    highest: f64,
    /// Lowest tension that a working gauge shows, N.
    lowest: f64,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Memory {
    /// Time for which each tendon has had too much tension, s.
    over: [f64; 4],
    /// Whether each gauge showed more than `pulled` when it was last below the end of its range.
    loaded: [bool; 4],
    /// Time for which each gauge has been out of its range, s.
    out: [f64; 4],
}

impl GaugeRange {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        Self {
            ends: GaugeEnds::new(finger),
            pulled: PULLED * finger.tendon.maximum,
            highest: OVERSHOOT * finger.tendon.maximum,
            lowest: -BELOW_ZERO * finger.tendon.minimum,
        }
    }

    pub fn watch(&self, memory: &mut Memory, sample: &Sample) -> Option<Alarm> {
        for gauge in 0..4 {
            let at_end = self.ends.at_highest(gauge, sample.feedback.gauge_counts[gauge], sample.full_scale);
            if !at_end {
                memory.loaded[gauge] = sample.tensions[gauge] > self.pulled;
            }
            let out = (at_end && !memory.loaded[gauge]) || sample.tensions[gauge] < self.lowest;
            let over = !out && (at_end || sample.tensions[gauge] > self.highest);
            memory.over[gauge] = if over { memory.over[gauge] + sample.elapsed } else { 0.0 };
            memory.out[gauge] = if out { memory.out[gauge] + sample.elapsed } else { 0.0 };
        }
        let counts = |gauge: usize| f64::from(sample.feedback.gauge_counts[gauge]);
        let out = first_of(Symptom::GaugeOutOfRange, Part::gauge, |gauge| {
            (memory.out[gauge] >= DURATION).then(|| counts(gauge))
        });
        let over = |tendon: usize| (memory.over[tendon] >= DURATION).then_some(sample.tensions[tendon]);
        out.or_else(|| first_of(Symptom::OverTension, Part::tendon, over))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::signals::{Feedback, Report};
    use nalgebra::Vector4;

    /// Watches a finger for 10 ms at each of these tensions of tendon 2. Gauge 2 is a falling gauge: its counts fall
    /// when the tension rises. `zero` is its zero.
    fn alarmed(zero: f64, tensions: &[f64]) -> Option<Symptom> {
        let mut finger = ConfiguredFinger::default();
        finger.gauge.newton_per_count[1] *= -1.0;
        finger.gauge.zero[1] = zero;
        let (monitor, mut memory, report) = (GaugeRange::new(&finger), Memory::default(), Report::default());
        let periods = tensions.iter().flat_map(|tension| [*tension; 10]);
        periods
            .map(|tension| {
                let scale = finger.gauge.newton_per_count[1];
                let count = (tension / scale + zero).clamp(0.0, 4095.0) as u16;
                let mut feedback = Feedback { gauge_counts: [400; 4], ..Feedback::default() };
                feedback.gauge_counts[1] = count;
                let mut shown = Vector4::repeat(10.0);
                shown[1] = (f64::from(count) - zero) * scale;
                let sample = Sample {
                    feedback: &feedback,
                    report: &report,
                    tensions: shown,
                    travel: Vector4::zeros(),
                    turned: Vector4::zeros(),
                    pulls: Vector4::zeros(),
                    elapsed: 1e-3,
                    full_scale: 4095,
                };
                monitor.watch(&mut memory, &sample)
            })
            .find_map(|alarm| alarm.map(|alarm| alarm.symptom))
    }

    #[test]
    fn a_slack_tendon_does_not_make_a_falling_gauge_defective() {
        assert_eq!(alarmed(4095.0, &[8.0, 0.0, 8.0]), None);
    }

    #[test]
    fn a_falling_gauge_at_its_high_end_shows_too_much_tension() {
        // The range of the gauge ends at 73 N, which is below the largest tolerated tension of 78 N.
        assert_eq!(alarmed(3000.0, &[8.0, 50.0, 90.0]), Some(Symptom::OverTension));
        // A gauge that jumps to its end is defective.
        assert_eq!(alarmed(3000.0, &[8.0, 90.0]), Some(Symptom::GaugeOutOfRange));
    }
}
