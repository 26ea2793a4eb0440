//! Detects a gauge that shows the same count permanently. A working gauge flickers in its last bits. The monitor learns
//! how much each gauge flickers. Working gauges without noise show constant counts at rest, so a gauge is judged only
//! while others flicker.

use super::alarm::{Alarm, Symptom, first_of};
use super::gauge_ends::GaugeEnds;
use super::sample::Sample;
use crate::model::Part;
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;

/// Gain per sample of the running mean `Memory::repeats`.
const LEARNING: f64 = 1.0 / 256.0;

/// Minimum number of samples before a gauge can be known to flicker.
const KNOWN: u32 = 256;

/// A gauge that repeats the same count for this number of consecutive samples was dead from the start, if all others
/// are known to flicker.
const DEAD_FROM_START: u32 = 512;

/// A gauge is reported as dead only if its tension differs from the commanded tension by more than this fraction of
/// t_min. A dead gauge reaches this difference soon, because the commands keep changing; at rest the dither changes
/// them. A working gauge without noise may repeat the same count permanently if its tendon has the commanded tension.
/// This was observed while other gauges flickered.
const OFFSET: f64 = 0.015;

/// Natural logarithm of a probability. A gauge that repeats one count is taken for dead if a working gauge with the
/// learned flicker would repeat it for so long with a lower probability than this. The value corresponds to one case in
/// 10^11 samples. Four gauges at 1000 Hz give this number of samples in about a year.
const UNLIKELY: f64 = -25.3;

/// Lowest assumed probability that a sample of a gauge repeats the previous one. While the tension changes, a gauge
/// rarely repeats a count. At rest it repeats counts more often, and must not be taken for a dead gauge.
const LEAST_REPEATS: f64 = 0.2;

/// Largest fraction of repeating samples with which a gauge is known to flicker. A gauge that repeats its count more
/// often has no noise, or its converter is slow.
const MOST_REPEATS: f64 = 0.7;

/// A gauge is known to flicker if it reverses its direction in more than this fraction of the samples, or if its counts
/// have enough bends (see [`LEAST_BENDS`]). Noise reverses the direction in about half of the samples, and motion
/// hardly ever. So a gauge without noise that comes to rest is not taken for a dead one.
const LEAST_REVERSALS: f64 = 0.15;

/// A gauge is also known to flicker if its counts have a bend in more than this fraction of the samples. At a bend, the
/// second difference of the counts changes its sign. While the dither of the tensions changes a tension by several
/// counts in a sample, noise hardly ever reverses the direction. The noise still changes the sign of the second
/// difference. A smooth tension does not change it.
const LEAST_BENDS: f64 = 0.05;

/// Smallest second difference that counts as a bend, counts. The second difference of a quantised smooth tension is
/// smaller, or keeps its sign.
const BEND: i32 = 2;

/// Gain per sample of the means of the reversals and of the bends. It is small, because noise is not visible during
/// fast motion.
const LEARNING_REVERSALS: f64 = 1.0 / 512.0;

/// Fraction of t_min below which a tendon may hang slack.
const SLACK: f64 = 0.3;

/// A gauge that has repeated the same count for this number of consecutive samples does not flicker at present. While
/// others flicker, it is being judged, and its samples are not learned.
const LEAST_ROW: u32 = 4;

/// A gauge that flickered and then repeated the same count for this number of consecutive samples is dead if gauges and
/// encoders disagree too.
const SILENT: u32 = 10;

/// The monitor of dead gauges. A gauge that is not known to flicker can be reported as dead in two cases. In the first
/// case, all others are known to flicker. In the second case, its tendon seems to lose its tension while the other
/// tendons keep theirs; see `tension_lost`.
#[derive(Clone, Debug)]
pub(super) struct GaugeStuck {
    ends: GaugeEnds,
    /// Tension below which a tendon may hang slack, N. The gauge of such a tendon is not used to judge others: if the
    /// range of the gauge ends there, only half of its noise is visible.
    slack: f64,
    /// Difference from the commanded tension beyond which a gauge may be dead, N.
    offset: f64,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Memory {
    last: [u16; 4],
    /// Number of consecutive samples with the same count.
    same: [u32; 4],
    /// Fraction of samples that repeat the previous one, 0 to 1.
    repeats: [f64; 4],
    /// Fraction of samples that reverse the direction, 0 to 1.
    reversals: [f64; 4],
    /// Whether the last change of each gauge was upward.
    rose: [bool; 4],
    samples: u32,
    /// Fraction of samples with a bend in the counts, 0 to 1.
    bends: [f64; 4],
    /// The first and the second difference of each gauge at the last sample, counts.
    differences: [[i32; 2]; 4],
    /// Tensions of the last sample, N.
    tensions: Vector4<f64>,
    /// Whether each gauge shows the count of its low end because its tension fell or drifted to the end of the range. A
    /// dead gauge often shows this count too, but its tension was not low before.
    at_lowest: [bool; 4],
}

impl Default for Memory {
    fn default() -> Self {
        Self {
            last: [0; 4],
            same: [0; 4],
            repeats: [1.0; 4],
            reversals: [0.0; 4],
            rose: [false; 4],
            samples: 0,
            bends: [0.0; 4],
            differences: [[0; 2]; 4],
            tensions: Vector4::zeros(),
            at_lowest: [false; 4],
        }
    }
}

/// The learned flicker of the four gauges.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flicker {
    /// Whether the gauge is known to flicker.
    pub known: [bool; 4],
    /// Number of consecutive samples with the same count.
    pub same: [u32; 4],
    /// Whether the gauge is at the end of its range. It then shows a constant count although it is not dead.
    pub saturated: [bool; 4],
}

impl Flicker {
    /// Returns whether a gauge that flickered has repeated the same count for at least [`SILENT`] samples within its
    /// range.
    pub fn silent(&self, gauge: usize) -> bool {
        self.known[gauge] && self.same[gauge] >= SILENT && !self.saturated[gauge]
    }
}

impl Memory {
    /// Notes the change of a gauge since the last sample, counts. Returns whether the second difference and the
    /// previous one have opposite signs and magnitudes of at least [`BEND`].
    fn bends_to_the_other_side(&mut self, gauge: usize, change: i32) -> bool {
        let [first, second] = self.differences[gauge];
        self.differences[gauge] = [change, change - first];
        second.abs().min((change - first).abs()) >= BEND && (second > 0) != (change > first)
    }
}

impl GaugeStuck {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        Self {
            ends: GaugeEnds::new(finger),
            slack: SLACK * finger.tendon.minimum,
            offset: OFFSET * finger.tendon.minimum,
        }
    }

    /// Returns the learned flicker of the gauges. `full_scale` is the largest count of the gauges.
    pub fn flickers(&self, memory: &Memory, full_scale: u16) -> Flicker {
        let known = std::array::from_fn(|gauge| {
            let reverses = memory.reversals[gauge] > LEAST_REVERSALS || memory.bends[gauge] > LEAST_BENDS;
            let noisy = memory.repeats[gauge] < MOST_REPEATS && reverses;
            memory.samples >= KNOWN && noisy
        });
        let saturated =
            |gauge: usize| self.ends.at_highest(gauge, memory.last[gauge], full_scale) || memory.at_lowest[gauge];
        Flicker { known, same: memory.same, saturated: std::array::from_fn(saturated) }
    }

    pub fn watch(&self, memory: &mut Memory, sample: &Sample) -> Option<Alarm> {
        let counts = sample.feedback.gauge_counts;
        memory.samples = memory.samples.saturating_add(1);
        let from_all = 1.0 / f64::from(memory.samples);
        let (fast, slow) = (LEARNING.max(from_all), LEARNING_REVERSALS.max(from_all));
        let last = std::mem::replace(&mut memory.last, counts);
        let same = |gauge: usize| counts[gauge] == last[gauge];
        let rises = |gauge: usize| counts[gauge] > last[gauge];
        memory.same = std::array::from_fn(|gauge| if same(gauge) { memory.same[gauge].saturating_add(1) } else { 0 });
        let same_for = memory.same;
        let before = std::mem::replace(&mut memory.tensions, sample.tensions);
        // Whether at least two other gauges, of tendons that are not slack, have changed recently.
        let others_flicker = |gauge: usize| {
            let flickers =
                |&other: &usize| other != gauge && same_for[other] < LEAST_ROW && sample.tensions[other] > self.slack;
            (0..4).filter(flickers).count() >= 2
        };
        for gauge in 0..4 {
            let bent = memory.bends_to_the_other_side(gauge, i32::from(counts[gauge]) - i32::from(last[gauge]));
            // Samples of a gauge that is being judged must not change the learned flicker.
            if memory.same[gauge] < LEAST_ROW || !others_flicker(gauge) {
                let learn = |mean: &mut f64, is: bool, gain: f64| *mean += (f64::from(u8::from(is)) - *mean) * gain;
                let same = memory.same[gauge] > 0;
                learn(&mut memory.repeats[gauge], same, fast);
                learn(&mut memory.bends[gauge], bent, slow);
                learn(&mut memory.reversals[gauge], !same && rises(gauge) != memory.rose[gauge], slow);
            }
            if memory.same[gauge] == 0 {
                memory.rose[gauge] = rises(gauge);
                let lowest = self.ends.at_lowest(gauge, counts[gauge], sample.full_scale);
                memory.at_lowest[gauge] = lowest && before[gauge] < self.slack;
            }
        }
        let Flicker { known, saturated, .. } = self.flickers(memory, sample.full_scale);
        let alone = |gauge: usize| (0..4).all(|other| other == gauge || known[other]);
        first_of(Symptom::GaugeStuck, Part::gauge, |gauge| {
            // The gauge of a slack tendon may be at the end of its range, and then shows only half of its noise.
            let least = if sample.tensions[gauge] < self.slack { MOST_REPEATS } else { LEAST_REPEATS };
            let unlikely = f64::from(memory.same[gauge]) * memory.repeats[gauge].max(least).ln() < UNLIKELY;
            let off = (sample.tensions[gauge] - sample.report.desired_tensions[gauge]).abs() > self.offset;
            let died = known[gauge] && unlikely && others_flicker(gauge);
            let was_dead = memory.same[gauge] >= DEAD_FROM_START && alone(gauge) && sample.tensions[gauge] > self.slack;
            (off && !saturated[gauge] && (died || was_dead)).then_some(f64::from(counts[gauge]))
        })
    }
}

/// Returns the alarm that this gauge, 0 to 3, is dead.
pub(super) fn alarm(sample: &Sample, gauge: usize) -> Alarm {
    let value = f64::from(sample.feedback.gauge_counts[gauge]);
    Alarm { symptom: Symptom::GaugeStuck, part: Part::gauge(gauge), value }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::signals::{Feedback, Report};

    /// At 1000 Hz, a gauge without noise reaches the largest number of repetitions, 2^32 - 1, in 50 days.
    #[test]
    fn a_gauge_may_repeat_its_count_more_often_than_can_be_counted() {
        let monitor = GaugeStuck::new(&ConfiguredFinger::default());
        let feedback = Feedback { gauge_counts: [400; 4], ..Feedback::default() };
        let mut memory = Memory { last: [400; 4], same: [u32::MAX; 4], samples: u32::MAX, ..Memory::default() };
        let sample = Sample {
            feedback: &feedback,
            report: &Report::default(),
            tensions: Vector4::repeat(10.0),
            travel: Vector4::zeros(),
            turned: Vector4::zeros(),
            pulls: Vector4::zeros(),
            elapsed: 1e-3,
            full_scale: 4095,
        };
        assert_eq!(monitor.watch(&mut memory, &sample), None);
        assert_eq!(memory.same, [u32::MAX; 4]);
    }
}
