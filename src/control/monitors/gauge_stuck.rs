//! A gauge that shows the same count for ever. A live one flickers in its last bits: how much, each gauge has shown
//! before. Gauges without noise are all still at rest: one is judged only while others flicker.

use super::alarm::{Alarm, Symptom, first_of};
use super::sample::Sample;
use crate::model::Part;
use crate::model::configuration::ConfiguredFinger;

/// Part of the way that the mean of the flicker goes in a sample.
const LEARNING: f64 = 1.0 / 256.0;

/// Samples after which the flicker is known.
const KNOWN: u32 = 256;

/// A gauge that shows one count in so many samples while all others are known to flicker was dead in the beginning.
const NEVER: u32 = 512;

/// A dead gauge is also off from the tension that is commanded by more than this part of t_min, before long: a
/// controller goes on, and the dither that is commanded does at rest. One without noise whose tendon is where it shall
/// be may show one count for ever, and did while others flickered.
const OFF: f64 = 0.015;

/// The chance at which a live gauge that flickers as before would show one count for so long, as a natural logarithm:
/// once in 10^11 samples, a year of four gauges at 1000 Hz.
const UNLIKELY: f64 = -25.3;

/// No gauge is taken to repeat itself less often than this: one in motion hardly does, and its flicker at rest is to be
/// known still.
const LEAST_REPEATS: f64 = 0.2;

/// A gauge that repeats itself more often than this is not known to flicker: without noise, or converted slowly.
const MOST_REPEATS: f64 = 0.7;

/// So many of the samples of a gauge with noise turn back from where the one before them went: about half do. Motion
/// does not turn back, so that a gauge without noise that comes to rest is not taken for a dead one.
const LEAST_REVERSALS: f64 = 0.15;

/// Part of the way that the mean of the reversals goes in a sample: slowly, because noise does not show in a fast
/// motion.
const LEARNING_REVERSALS: f64 = 1.0 / 512.0;

/// Part of t_min below which a tendon may hang.
const SLACK: f64 = 0.3;

/// So many samples with the same count are a row that a gauge may be judged by.
const ROW: u32 = 4;

/// A gauge that flickered and then showed one count in so many samples is dead if something else says so too.
const SILENT: u32 = 10;

/// Without flicker a gauge is dead only for its tendon's sake; see `tension_lost`.
#[derive(Clone, Debug)]
pub(super) struct GaugeStuck {
    /// Below so much, N, a tendon may hang, and where its gauge ends noise shows on one side only: no witness for
    /// another.
    slack: f64,
    /// N.
    off: f64,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Memory {
    last: [u16; 4],
    /// Samples with the same count, in a row.
    same: [u32; 4],
    /// How often a sample repeats the one before, 0 to 1.
    repeats: [f64; 4],
    /// How often a sample turns back, 0 to 1.
    reversals: [f64; 4],
    /// Whether each gauge last rose.
    rose: [bool; 4],
    samples: u32,
}

impl Default for Memory {
    fn default() -> Self {
        Self { last: [0; 4], same: [0; 4], repeats: [1.0; 4], reversals: [0.0; 4], rose: [false; 4], samples: 0 }
    }
}

/// What is known of the flicker of four gauges.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flicker {
    /// Whether the gauge is known to flicker.
    pub known: [bool; 4],
    /// Samples with the same count, in a row.
    pub same: [u32; 4],
}

impl Flicker {
    /// Whether a gauge that flickered shows one count.
    pub fn silent(&self, gauge: usize) -> bool {
        self.known[gauge] && self.same[gauge] >= SILENT
    }
}

impl Memory {
    pub fn flickers(&self) -> Flicker {
        let known = std::array::from_fn(|gauge| {
            let noisy = self.repeats[gauge] < MOST_REPEATS && self.reversals[gauge] > LEAST_REVERSALS;
            self.samples >= KNOWN && noisy
        });
        Flicker { known, same: self.same }
    }
}

impl GaugeStuck {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        Self { slack: SLACK * finger.tendon.minimum, off: OFF * finger.tendon.minimum }
    }

    pub fn watch(&self, memory: &mut Memory, sample: &Sample) -> Option<Alarm> {
        let counts = sample.feedback.gauge_counts;
        memory.samples = memory.samples.saturating_add(1);
        let from_all = 1.0 / f64::from(memory.samples);
        let (fast, slow) = (LEARNING.max(from_all), LEARNING_REVERSALS.max(from_all));
        let last = std::mem::replace(&mut memory.last, counts);
        let same = |gauge: usize| counts[gauge] == last[gauge];
        let rises = |gauge: usize| counts[gauge] > last[gauge];
        memory.same = std::array::from_fn(|gauge| if same(gauge) { memory.same[gauge] + 1 } else { 0 });
        let same_for = memory.same;
        // Whether at least two other gauges have just moved.
        let others_flicker = |gauge: usize| {
            let flickers =
                |&other: &usize| other != gauge && same_for[other] < ROW && sample.tensions[other] > self.slack;
            (0..4).filter(flickers).count() >= 2
        };
        for gauge in 0..4 {
            // What is judged must not shift the judgement.
            if memory.same[gauge] < ROW || !others_flicker(gauge) {
                let learn = |mean: &mut f64, is: bool, gain: f64| *mean += (f64::from(u8::from(is)) - *mean) * gain;
                let same = memory.same[gauge] > 0;
                learn(&mut memory.repeats[gauge], same, fast);
                learn(&mut memory.reversals[gauge], !same && rises(gauge) != memory.rose[gauge], slow);
            }
            if memory.same[gauge] == 0 {
                memory.rose[gauge] = rises(gauge);
            }
        }
        let known = memory.flickers().known;
        let alone = |gauge: usize| (0..4).all(|other| other == gauge || known[other]);
        first_of(Symptom::GaugeStuck, Part::gauge, |gauge| {
            // Where a tendon hangs its gauge may be at its end, and show half of the noise only.
            let least = if sample.tensions[gauge] < self.slack { MOST_REPEATS } else { LEAST_REPEATS };
            let unlikely = f64::from(memory.same[gauge]) * memory.repeats[gauge].max(least).ln() < UNLIKELY;
            let off = (sample.tensions[gauge] - sample.report.desired_tensions[gauge]).abs() > self.off;
            let died = known[gauge] && unlikely && others_flicker(gauge);
            let was_dead = memory.same[gauge] >= NEVER && alone(gauge) && sample.tensions[gauge] > self.slack;
            (off && (died || was_dead)).then_some(f64::from(counts[gauge]))
        })
    }
}

/// That this gauge, 0 to 3, is dead.
pub(super) fn alarm(sample: &Sample, gauge: usize) -> Alarm {
    let value = f64::from(sample.feedback.gauge_counts[gauge]);
    Alarm { symptom: Symptom::GaugeStuck, part: Part::gauge(gauge), value }
}
