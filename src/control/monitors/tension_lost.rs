//! Tendons that lose their tension: torn, slipping, or with a gauge that is dead.

use super::gauge_stuck::Flicker;
use super::{Alarm, Alarms, Sample, Symptom, first_of};
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;

/// A tendon is low below this part of t_min. No command asks for less than t_min.
const LOW: f64 = 0.3;

/// Its tension is gone below this part.
const GONE: f64 = 0.1;

/// So long, s, a tendon is low or gone only if something is wrong; a step at the largest stiffness takes less.
const LASTS: f64 = 0.012;

/// So long, s, tension must be gone for a warning.
const NOTICED: f64 = 0.003;

/// A gauge that flickered and then showed one count in so many samples is dead.
const SILENT: u32 = 6;

#[derive(Clone, Debug)]
pub(super) struct TensionLost {
    /// N.
    low: f64,
    gone: f64,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Memory {
    /// For how long each tendon has been low, s, and its tension since, N s.
    low: Vector4<f64>,
    impulse: Vector4<f64>,
    /// For how long its tension has been gone, s.
    gone: Vector4<f64>,
}

impl TensionLost {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        Self { low: LOW * finger.tendon.minimum, gone: GONE * finger.tendon.minimum }
    }

    pub fn watch(&self, memory: &mut Memory, sample: &Sample, flicker: &Flicker) -> Alarms {
        for tendon in 0..4 {
            let tension = sample.tensions[tendon];
            let counted = |so_far: f64, holds: bool| if holds { so_far + sample.elapsed } else { 0.0 };
            memory.low[tendon] = counted(memory.low[tendon], tension < self.low);
            memory.gone[tendon] = counted(memory.gone[tendon], tension < self.gone);
            let impulse = memory.impulse[tendon] + tension * sample.elapsed;
            memory.impulse[tendon] = if tension < self.low { impulse } else { 0.0 };
        }
        let warning = first_of(Symptom::SlackInMotion, |tendon| {
            (memory.gone[tendon] >= NOTICED).then_some(sample.tensions[tendon])
        });
        // The others follow a torn tendon, as nothing balances them: the one that went first is it.
        let tendon = memory.low.imax();
        let fault = (memory.low[tendon] >= LASTS).then(|| self.fault(memory, sample, flicker, tendon));
        Alarms { fault: fault.flatten(), warning }
    }

    fn fault(&self, memory: &Memory, sample: &Sample, flicker: &Flicker, tendon: usize) -> Option<Alarm> {
        let part = tendon as u8 + 1;
        let mean = memory.impulse[tendon] / memory.low[tendon];
        let others_hold = (0..4).all(|other| other == tendon || memory.low[other] == 0.0);
        let dead = match flicker.known[tendon] {
            // A little later it is certain.
            true if flicker.same[tendon] >= SILENT => return None,
            true => false,
            false => others_hold,
        };
        Some(if dead {
            let count = f64::from(sample.feedback.gauge_counts[tendon]);
            Alarm { symptom: Symptom::GaugeStuck, part, value: count }
        } else if mean < self.gone {
            Alarm { symptom: Symptom::BrokenTendon, part, value: mean }
        } else {
            Alarm { symptom: Symptom::SlackTendon, part, value: mean }
        })
    }
}
