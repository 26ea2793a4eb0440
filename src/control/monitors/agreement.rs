//! Compares gauges with encoders. Three joint angles determine the travel of four tendons, so four motor angles and
//! four tensions are redundant by one. For n with R n = 0,
//!
//! n^T (r m - (t - t_home) / k) = 0
//!
//! for any joint angles. Equivalently, three tendons determine the tension of the fourth,
//!
//! t = k (r m - R^T theta) + t_home.
//!
//! The difference at the start of monitoring counts as zero, because encoders that were never zeroed are no reason to
//! stop a finger.

use super::alarm::{Alarm, Symptom};
use super::sample::Sample;
use crate::model::configuration::ConfiguredFinger;
use crate::model::{Part, Tendons};
use nalgebra::Vector4;

/// Disagreement that is always tolerated, N. In addition, a fraction of the change of the tensions is tolerated,
/// because k is not known exactly.
const TOLERANCE: f64 = 0.5;

/// Fraction of t_min below which a tendon may hang slack. The encoders then show a negative stretch, so the difference
/// is negative too.
const SLACK: f64 = 0.35;

/// Number of samples whose mean difference counts as zero.
const ZEROING: u32 = 32;

/// Time for which the disagreement must last, s.
const DURATION: f64 = 0.01;

/// Gain per sample of the mean imbalance between pull and tension.
const AVERAGING: f64 = 0.05;

#[derive(Clone, Debug)]
pub(super) struct Agreement {
    /// Weights of the travels, N/cm: n, which is all positive, divided by the sum of n / k.
    of_travel: Vector4<f64>,
    /// Weights of the tensions: n / k, scaled so that an error of 1 N in all tensions gives a difference of 1 N.
    of_tension: Vector4<f64>,
    /// Tensions at which the encoders are zeroed, N.
    home: Vector4<f64>,
    /// Tension below which a tendon may hang slack, N.
    slack: f64,
    /// `tendon.stiffness_tolerance`.
    tolerance: f64,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Memory {
    /// Mean difference during zeroing, N.
    zero: f64,
    /// Mean tensions above the homing pretension during zeroing, N.
    above: Vector4<f64>,
    samples: u32,
    /// Difference after subtraction of the zero, N.
    difference: f64,
    /// Disagreement divided by the tolerated one.
    ratio: f64,
    /// Time for which the disagreement has lasted, s.
    duration: f64,
    /// Tension of each tendon minus the tension that its gauge shows, if the other three gauges are right, N.
    missing: Vector4<f64>,
    /// Mean of pull minus tension of each tendon, N.
    unbalanced: Vector4<f64>,
}

impl Memory {
    /// Returns `missing` of the last sample, N.
    pub fn missing(&self) -> Vector4<f64> {
        self.missing
    }

    /// Returns whether the disagreement exceeds half of the tolerated one.
    pub fn doubtful(&self) -> bool {
        self.ratio > 0.5
    }
}

impl Agreement {
    pub fn new(finger: &ConfiguredFinger, tendons: &Tendons) -> Self {
        // R times the ghost column of Q is zero.
        let null: Vector4<f64> = tendons.q.column(3).into_owned();
        let per_stiffness = null.component_div(&Vector4::from(finger.tendon.stiffness));
        let whole = per_stiffness.sum();
        Self {
            of_travel: null / whole,
            of_tension: per_stiffness / whole,
            home: tendons.pretension(finger.tendon.minimum),
            slack: SLACK * finger.tendon.minimum,
            tolerance: finger.tendon.stiffness_tolerance,
        }
    }

    /// Computes the difference of one sample.
    pub fn compare(&self, memory: &mut Memory, sample: &Sample) {
        memory.unbalanced += (sample.pulls - sample.tensions - memory.unbalanced) * AVERAGING;
        let above = sample.tensions - self.home;
        let difference = self.of_travel.dot(&sample.travel) - self.of_tension.dot(&above);
        let hangs = sample.tensions.min() < self.slack;
        if memory.samples < ZEROING {
            if !hangs {
                memory.samples += 1;
                memory.zero += (difference - memory.zero) / f64::from(memory.samples);
                memory.above += (above - memory.above) / f64::from(memory.samples);
            }
            return;
        }
        memory.difference = difference - memory.zero;
        memory.missing = self.of_tension.map(|share| memory.difference / share);
        let explained = memory.difference < 0.0 && hangs;
        let tolerated = TOLERANCE + self.tolerance * self.of_tension.dot(&(above - memory.above).abs());
        memory.ratio = if explained { 0.0 } else { memory.difference.abs() / tolerated };
    }

    /// Returns an alarm if the disagreement has lasted too long. `explained` means that another fault causes the
    /// disagreement.
    pub fn watch(&self, memory: &mut Memory, sample: &Sample, explained: bool) -> Option<Alarm> {
        let counts = memory.ratio > 1.0 && !explained;
        memory.duration = if counts { memory.duration + sample.elapsed } else { 0.0 };
        // The suspect is the gauge that differs most from the pull of its motor.
        let suspect = Part::gauge(memory.unbalanced.iamax());
        let alarm = Alarm { symptom: Symptom::GaugeDisagrees, part: suspect, value: memory.difference };
        (memory.duration >= DURATION).then_some(alarm)
    }
}
