//! Detects tendons that are torn, slip or have a dead gauge.
//!
//! A fast motion or an impact makes an intact tendon slack for a moment, and the tendon hangs. A torn or slipping
//! tendon, or one with a dead gauge, shows no tension although the other three gauges and the encoders indicate that it
//! is stretched. In these cases the difference between indicated and shown tension appears from one sample to the next.
//! A tendon that hung is different: the encoders first indicate that it is not stretched. Until it is taut again, the
//! tendons slide in other directions than before, so their friction may indicate a stretch that does not exist.
//!
//! If the difference grew while the gauge still showed tension, the gauge drifts, and the controller keeps the tendon
//! at the tension that the gauge shows. `agreement` detects that case.

use super::agreement::Missing;
use super::alarm::{Alarm, Alarms, Symptom, first_of};
use super::gauge_stuck::{self, Flicker};
use super::sample::Sample;
use crate::model::Part;
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;

/// Fraction of t_min below which a tendon is low. No command is below t_min.
const LOW: f64 = 0.3;

/// Fraction of t_min below which the tension of a tendon is gone.
const GONE: f64 = 0.1;

/// The missing tension is the tension that the stretch indicates minus the tension that the gauge shows. The missing
/// tension of a low tendon counts if it has risen by more than this fraction of t_min. The rise is measured from the
/// mean before any tendon became low. This mean is not zero on a finger with friction along its tendons or with inexact
/// parameters.
const MISSED: f64 = 0.3;

/// If the mean of the missing tension (see [`MISSED`]) is positive, the missing tension must rise further by this
/// fraction of the mean before it counts. A positive mean shows that the configuration indicates too much stretch. The
/// configuration indicates even more stretch when the tensions of the other tendons rise.
const INEXACT: f64 = 0.5;

/// A low tendon that shows some tension does not count as slipping if another tendon became low within this time before
/// or after it, s. The tendons of a finger whose clamp slips lose their tension one after the other. If the
/// configuration is not exact, the controller may command small pulls. Two tendons of an intact finger can then lose
/// their tension together in a push. With a condition on the pull of the motor instead of this time, a slipping tendon
/// was reported only after 56 ms.
const TOGETHER: f64 = 0.004;

/// Time constant of the mean of the missing tension before any tendon became low, s.
const BEFORE: f64 = 0.02;

/// Time for which a tendon must be low and its missing tension must count, s.
const DURATION: f64 = 0.012;

/// Time after which a low tendon has lost its tension, s. No motion keeps an intact tendon slack for so long.
const TOO_LONG: f64 = 0.5;

/// Time for which the tension of a tendon must be gone before a warning is given, s.
const NOTICED: f64 = 0.003;

/// A gauge that flickered is dead if its count has not changed since its tendon became low, in at least this number of
/// samples. Fewer samples are not enough: if the range of a gauge ends at zero tension, only half of its noise is
/// visible, and the gauge of a torn tendon occasionally repeats a count too.
const CERTAIN: u32 = 15;

#[derive(Clone, Debug)]
pub(super) struct TensionLost {
    /// Tension below which a tendon is low, N.
    low: f64,
    /// Tension below which the tension of a tendon is gone, N.
    gone: f64,
    /// Rise above which the missing tension of a low tendon counts, N (see [`MISSED`]).
    missed: f64,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Memory {
    /// Time for which each tendon has been low, s.
    low: Vector4<f64>,
    /// Number of samples in this time.
    samples: [u32; 4],
    /// Integral of the tension over this time, N s.
    impulse: Vector4<f64>,
    /// Mean of the missing tension before any tendon became low, N.
    before: Vector4<f64>,
    /// Whether each tendon has hung since it became low.
    hung: [bool; 4],
    /// Time for which each tendon has been low and its missing tension has counted, s.
    missed: Vector4<f64>,
    /// Time for which the tension of each tendon has been gone, s.
    gone: Vector4<f64>,
}

impl Memory {
    /// Notes that the comparison of gauges and encoders restarts. The missing tensions then begin at zero again.
    pub fn restart_comparison(&mut self) {
        self.before = Vector4::zeros();
    }

    /// Returns whether a tendon seems to have just lost its tension.
    pub fn suspects(&self) -> bool {
        self.missed.max() > 0.0
    }
}

impl TensionLost {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        let minimum = finger.tendon.minimum;
        Self { low: LOW * minimum, gone: GONE * minimum, missed: MISSED * minimum }
    }

    /// Returns the alarms.
    pub fn watch(&self, memory: &mut Memory, sample: &Sample, missing: &Missing, flicker: &Flicker) -> Alarms {
        let any_low = sample.tensions.min() < self.low;
        for tendon in 0..4 {
            let tension = sample.tensions[tendon];
            let low = tension < self.low;
            let counted = |so_far: f64, holds: bool| if holds { so_far + sample.elapsed } else { 0.0 };
            memory.low[tendon] = counted(memory.low[tendon], low);
            memory.samples[tendon] = if low { memory.samples[tendon].saturating_add(1) } else { 0 };
            if !any_low {
                let change = missing.tensions[tendon] - memory.before[tendon];
                memory.before[tendon] += change * (sample.elapsed / BEFORE).min(1.0);
            }
            let suddenly = missing.tensions[tendon] - memory.before[tendon];
            let missed = self.missed + INEXACT * memory.before[tendon].max(0.0);
            memory.hung[tendon] = low && (memory.hung[tendon] || suddenly < -self.missed);
            let by_friction = if memory.hung[tendon] { missing.by_friction[tendon] } else { 0.0 };
            memory.missed[tendon] = counted(memory.missed[tendon], low && suddenly > missed + by_friction);
            memory.gone[tendon] = counted(memory.gone[tendon], tension < self.gone);
            let impulse = memory.impulse[tendon] + tension * sample.elapsed;
            memory.impulse[tendon] = if low { impulse } else { 0.0 };
        }
        let warning = first_of(Symptom::SlackInMotion, Part::tendon, |tendon| {
            (memory.gone[tendon] >= NOTICED).then_some(sample.tensions[tendon])
        });
        // After a tendon has torn, the others lose their tension too, because nothing balances them. So the tendon that
        // lost its tension first is reported.
        let (missed, lowest) = (memory.missed.imax(), memory.low.imax());
        let suddenly =
            if memory.missed[missed] >= DURATION { self.fault(memory, sample, flicker, missed) } else { None };
        let too_long = || (memory.low[lowest] >= TOO_LONG).then(|| self.lost(memory, lowest));
        Alarms { fault: suddenly.or_else(too_long), warning }
    }

    fn fault(&self, memory: &Memory, sample: &Sample, flicker: &Flicker, tendon: usize) -> Option<Alarm> {
        let others_hold = (0..4).all(|other| other == tendon || memory.low[other] == 0.0);
        let same = flicker.same[tendon];
        let silent = flicker.known[tendon] && same >= memory.samples[tendon].saturating_sub(1);
        let dead = match flicker.known[tendon] {
            // More samples are needed to be certain.
            true if silent && same < CERTAIN => return None,
            true => silent,
            false => others_hold,
        };
        if dead {
            return Some(gauge_stuck::alarm(sample, tendon));
        }
        let together = (0..4).any(|other| {
            let apart = memory.low[tendon] - memory.low[other];
            other != tendon && memory.low[other] > 0.0 && apart.abs() <= TOGETHER
        });
        let lost = self.lost(memory, tendon);
        (lost.symptom == Symptom::BrokenTendon || !together).then_some(lost)
    }

    fn lost(&self, memory: &Memory, tendon: usize) -> Alarm {
        let mean = memory.impulse[tendon] / memory.low[tendon];
        let symptom = if mean < self.gone { Symptom::BrokenTendon } else { Symptom::SlackTendon };
        Alarm { symptom, part: Part::tendon(tendon), value: mean }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::signals::{Feedback, Report};

    /// Returns the fault that a finger has within 0.1 s after its tendons have lost tension.
    fn fault(before: f64, then: f64, shown: [f64; 4]) -> Option<Symptom> {
        fault_within(100, before, then, shown)
    }

    /// Returns the fault of a finger. For 0.1 s, its gauges show 10 N, and the missing tension of tendon 0 is `before`,
    /// N. Then, for `time` ms, the gauges show the tensions `shown`, N, and the missing tension of tendon 0 is `then`,
    /// N.
    fn fault_within(time: usize, before: f64, then: f64, shown: [f64; 4]) -> Option<Symptom> {
        let lost = TensionLost::new(&ConfiguredFinger::default());
        let (feedback, report) = (Feedback::default(), Report::default());
        let mut memory = Memory::default();
        (0..100 + time).find_map(|cycle| {
            let (missing, tensions) = if cycle < 100 { (before, [10.0; 4]) } else { (then, shown) };
            let sample = Sample {
                feedback: &feedback,
                report: &report,
                tensions: tensions.into(),
                travel: Vector4::zeros(),
                turned: Vector4::zeros(),
                pulls: Vector4::zeros(),
                elapsed: 0.001,
                full_scale: 4095,
            };
            // The gauges are known to flicker, so none of them is taken for a dead one.
            let flicker = Flicker { known: [true; 4], same: [0; 4], saturated: [false; 4] };
            let missing = Missing { tensions: Vector4::new(missing, 0.0, 0.0, 0.0), by_friction: Vector4::zeros() };
            lost.watch(&mut memory, &sample, &missing, &flicker).fault.map(|alarm| alarm.symptom)
        })
    }

    #[test]
    fn on_a_finger_that_is_not_exact_more_tension_must_be_missing() {
        let low = [1.1, 14.0, 15.0, 14.0];
        assert_eq!(fault(0.0, 1.7, low), Some(Symptom::SlackTendon));
        assert_eq!(fault(3.4, 3.4 + 1.7, low), None);
        assert_eq!(fault(3.4, 3.4 + 4.0, low), Some(Symptom::SlackTendon));
        assert_eq!(fault(-1.9, -1.9 + 1.7, low), Some(Symptom::SlackTendon));
    }

    #[test]
    fn two_tendons_that_become_low_together_do_not_slip() {
        assert_eq!(fault(0.0, 7.0, [1.1, 20.0, 20.0, 1.2]), None);
        assert_eq!(fault_within(495, 0.0, 7.0, [1.1, 20.0, 20.0, 1.2]), None);
        assert_eq!(fault_within(505, 0.0, 7.0, [1.1, 20.0, 20.0, 1.2]), Some(Symptom::SlackTendon));
        assert_eq!(fault(0.0, 7.0, [0.0, 20.0, 20.0, 1.2]), Some(Symptom::BrokenTendon));
    }
}
