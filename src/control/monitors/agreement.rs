//! Gauges against encoders. Joints have three freedoms and tendons are four, so that four motor angles and four
//! tensions are one more than it takes: for n with R n = 0,
//!
//! n^T (r m - (t - t_home) / k) = 0
//!
//! whatever the joints do, or with three tendons the tension of the fourth, t = k (r m - R^T theta) + t_home. What it
//! is when watching begins is taken for zero: encoders that were never zeroed are no reason to stop a finger.

use super::alarm::{Alarm, Symptom};
use super::sample::Sample;
use crate::model::configuration::ConfiguredFinger;
use crate::model::{Part, Tendons};
use nalgebra::Vector4;

/// Disagreement that is let pass, N; besides it what an error of k explains, a part of the change of the tensions.
const LET_PASS: f64 = 0.5;

/// Below this part of t_min a tendon may hang, and then it stretches less than nothing: the difference is below zero.
const SLACK: f64 = 0.35;

/// Samples whose mean is the zero.
const ZEROING: u32 = 32;

/// So long, s, the disagreement must last.
const LASTS: f64 = 0.01;

/// Part of the way that the mean out-of-balance goes in a sample.
const AVERAGING: f64 = 0.05;

#[derive(Clone, Debug)]
pub(super) struct Agreement {
    /// n, all positive, of such a length that all tensions off by 1 N disagree by 1 N.
    of_travel: Vector4<f64>,
    of_tension: Vector4<f64>,
    /// N.
    home: Vector4<f64>,
    slack: f64,
    /// `tendon.stiffness_tolerance`.
    tolerance: f64,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Memory {
    zero: f64,
    /// Mean tensions above rest while the zero was found, N.
    above: Vector4<f64>,
    samples: u32,
    /// Less the zero, N.
    difference: f64,
    /// Disagreement over what is let pass.
    part: f64,
    lasts: f64,
    /// What each tendon would have beyond what its gauge shows if the other three are right, N.
    missing: Vector4<f64>,
    /// Mean of pull minus tension of each tendon, N.
    unbalanced: Vector4<f64>,
}

impl Memory {
    /// What each tendon would have beyond what its gauge shows if the other three are right, N.
    pub fn missing(&self) -> Vector4<f64> {
        self.missing
    }

    /// Whether gauges and encoders are on the way to disagreement.
    pub fn doubtful(&self) -> bool {
        self.part > 0.5
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

    /// One sample's difference.
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
        let let_pass = LET_PASS + self.tolerance * self.of_tension.dot(&(above - memory.above).abs());
        memory.part = if explained { 0.0 } else { memory.difference.abs() / let_pass };
    }

    /// Whether it is too much. `explained`: something else makes them disagree.
    pub fn watch(&self, memory: &mut Memory, sample: &Sample, explained: bool) -> Option<Alarm> {
        let counts = memory.part > 1.0 && !explained;
        memory.lasts = if counts { memory.lasts + sample.elapsed } else { 0.0 };
        // The gauge that its motor contradicts most.
        let suspect = Part::gauge(memory.unbalanced.iamax());
        let alarm = Alarm { symptom: Symptom::GaugeDisagrees, part: suspect, value: memory.difference };
        (memory.lasts >= LASTS).then_some(alarm)
    }
}
