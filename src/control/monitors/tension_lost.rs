//! Tendons that lose their tension: torn, slipping, or with a gauge that is dead.
//!
//! A fast motion or a blow makes a whole tendon slack for a moment. Then it hangs; one that is torn, slips, or has a
//! dead gauge has no tension although the other three and the encoders say that it is stretched. They say so from one
//! sample to the next: where it grew while the gauge still showed tension, a gauge drifts, and its controller keeps the
//! tendon at what the gauge shows; that is for `agreement` to say.

use super::alarm::{Alarm, Alarms, Symptom, first_of};
use super::gauge_stuck::{self, Flicker};
use super::sample::Sample;
use crate::model::Part;
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;

/// A tendon is low below this part of t_min. No command asks for less than t_min.
const LOW: f64 = 0.3;

/// Its tension is gone below this part.
const GONE: f64 = 0.1;

/// From this part of t_min on a low tendon is missed: its stretch says that it should have so much, and did not before
/// it went low.
const MISSED: f64 = 0.3;

/// Time constant, s, of what it said before.
const BEFORE: f64 = 0.02;

/// So long, s, a tendon that is missed must be low.
const LASTS: f64 = 0.012;

/// So long, s, no motion makes a whole tendon slack.
const TOO_LONG: f64 = 0.5;

/// So long, s, tension must be gone for a warning.
const NOTICED: f64 = 0.003;

/// A gauge that flickered, and has shown one count in this many samples since its tendon is low, is dead. Where a gauge
/// ends at no tension noise shows on one side only, and that of a torn tendon shows one count now and then.
const CERTAIN: u32 = 15;

#[derive(Clone, Debug)]
pub(super) struct TensionLost {
    /// N.
    low: f64,
    gone: f64,
    missed: f64,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Memory {
    /// For how long each tendon has been low, s, in how many samples, and its tension since, N s.
    low: Vector4<f64>,
    samples: [u32; 4],
    impulse: Vector4<f64>,
    /// Mean of what its stretch said beyond its gauge before it went low, N.
    before: Vector4<f64>,
    /// For how long it has been low and missed, s.
    missed: Vector4<f64>,
    /// For how long its tension has been gone, s.
    gone: Vector4<f64>,
}

impl Memory {
    /// Whether a tendon seems to have lost its tension a moment ago.
    pub fn suspects(&self) -> bool {
        self.missed.max() > 0.0
    }
}

impl TensionLost {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        let minimum = finger.tendon.minimum;
        Self { low: LOW * minimum, gone: GONE * minimum, missed: MISSED * minimum }
    }

    /// `missing`: what each tendon would have beyond what its gauge shows if the other three are right, N.
    pub fn watch(&self, memory: &mut Memory, sample: &Sample, missing: &Vector4<f64>, flicker: &Flicker) -> Alarms {
        for tendon in 0..4 {
            let tension = sample.tensions[tendon];
            let low = tension < self.low;
            let counted = |so_far: f64, holds: bool| if holds { so_far + sample.elapsed } else { 0.0 };
            memory.low[tendon] = counted(memory.low[tendon], low);
            memory.samples[tendon] = if low { memory.samples[tendon].saturating_add(1) } else { 0 };
            if !low {
                memory.before[tendon] += (missing[tendon] - memory.before[tendon]) * (sample.elapsed / BEFORE).min(1.0);
            }
            let suddenly = missing[tendon] - memory.before[tendon].max(0.0);
            memory.missed[tendon] = counted(memory.missed[tendon], low && suddenly > self.missed);
            memory.gone[tendon] = counted(memory.gone[tendon], tension < self.gone);
            let impulse = memory.impulse[tendon] + tension * sample.elapsed;
            memory.impulse[tendon] = if low { impulse } else { 0.0 };
        }
        let warning = first_of(Symptom::SlackInMotion, Part::tendon, |tendon| {
            (memory.gone[tendon] >= NOTICED).then_some(sample.tensions[tendon])
        });
        // The others follow a torn tendon, as nothing balances them: the one that went first is it.
        let (missed, lowest) = (memory.missed.imax(), memory.low.imax());
        let fault = if memory.missed[missed] >= LASTS {
            self.fault(memory, sample, flicker, missed)
        } else {
            (memory.low[lowest] >= TOO_LONG).then(|| self.lost(memory, lowest))
        };
        Alarms { fault, warning }
    }

    fn fault(&self, memory: &Memory, sample: &Sample, flicker: &Flicker, tendon: usize) -> Option<Alarm> {
        let others_hold = (0..4).all(|other| other == tendon || memory.low[other] == 0.0);
        let same = flicker.same[tendon];
        let silent = flicker.known[tendon] && same + 1 >= memory.samples[tendon];
        let dead = match flicker.known[tendon] {
            // A little later it is certain.
            true if silent && same < CERTAIN => return None,
            true => silent,
            false => others_hold,
        };
        Some(if dead { gauge_stuck::alarm(sample, tendon) } else { self.lost(memory, tendon) })
    }

    fn lost(&self, memory: &Memory, tendon: usize) -> Alarm {
        let mean = memory.impulse[tendon] / memory.low[tendon];
        let symptom = if mean < self.gone { Symptom::BrokenTendon } else { Symptom::SlackTendon };
        Alarm { symptom, part: Part::tendon(tendon), value: mean }
    }
}
