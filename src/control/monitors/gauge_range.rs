//! Gauges at the end of their range, and tendons pulled beyond theirs.

use super::alarm::{Alarm, Symptom, first_of};
use super::sample::Sample;
use crate::model::Part;
use crate::model::configuration::ConfiguredFinger;

/// A tendon may exceed t_max by this factor: commands keep t_max, but blows and steps overshoot it.
const BEYOND: f64 = 1.3;

/// So far below no tension, over t_min, a gauge reads only if it is wrong.
const BELOW_NOTHING: f64 = 0.5;

/// A gauge that goes to its end from beyond this part of t_max has been pulled there; one that fails jumps.
const PULLED: f64 = 0.5;

/// So long, s, either must last.
const LASTS: f64 = 0.004;

#[derive(Clone, Debug)]
pub(super) struct GaugeRange {
    /// N.
    pulled: f64,
    highest: f64,
    lowest: f64,
}

/// For how long each tendon has been beyond, and each gauge out of its range, s.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Memory {
    over: [f64; 4],
    /// Whether each gauge was well loaded, but not at its end, when it last was not.
    loaded: [bool; 4],
    out: [f64; 4],
}

impl GaugeRange {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        Self {
            pulled: PULLED * finger.tendon.maximum,
            highest: BEYOND * finger.tendon.maximum,
            lowest: -BELOW_NOTHING * finger.tendon.minimum,
        }
    }

    pub fn watch(&self, memory: &mut Memory, sample: &Sample) -> Option<Alarm> {
        for gauge in 0..4 {
            let at_end = sample.feedback.gauge_counts[gauge] >= sample.full_scale;
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
            (memory.out[gauge] >= LASTS).then(|| counts(gauge))
        });
        let over = |tendon: usize| (memory.over[tendon] >= LASTS).then_some(sample.tensions[tendon]);
        out.or_else(|| first_of(Symptom::OverTension, Part::tendon, over))
    }
}
