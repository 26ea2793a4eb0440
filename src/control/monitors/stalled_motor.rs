//! Detects motors that do not turn although pull and tension are not balanced.

use super::alarm::{Alarm, Symptom, first_of};
use super::sample::Sample;
use crate::control::motors::motor_friction::MotorFriction;
use crate::model::configuration::ConfiguredFinger;
use crate::model::{Part, Tendons};
use nalgebra::Vector4;

/// Lower bound of the tolerated imbalance, as a multiple of the configured friction. This bound matters only if it is
/// above the imbalance that `monitors.stall_torque` and `monitors.stall_fraction` together tolerate. Otherwise these
/// two keys decide, so a low configured friction does not make the monitor more sensitive.
const FRICTION: f64 = 1.5;

/// Total time for which the imbalance must exceed the tolerated one, s. In this time a free motor would turn by dozens
/// of counts under the smallest imbalance that this monitor reports.
///
/// The dither makes the imbalance of a jammed motor oscillate. In one period of the dither, the imbalance may exceed
/// the tolerated one for less than this time. The times of several periods are added, as long as the motor does not
/// turn between them. A free motor that follows the dither turns by a multiple of [`AT_REST`] in each period.
const DURATION: f64 = 0.012;

/// Largest motion of a motor that is considered to be at rest, rad. The last bit of an encoder flickers.
const AT_REST: f64 = 0.007;

#[derive(Clone, Debug)]
pub(super) struct StalledMotor {
    /// `monitors.stall_torque` as a tension, N.
    imbalance: Vector4<f64>,
    /// `monitors.stall_fraction`.
    fraction: f64,
    friction: MotorFriction,
    /// If the imbalance stays within the tolerated one for longer than this time, s, the duration restarts. The time is
    /// a period of the dither, or 0 without dither.
    longest_gap: f64,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Memory {
    /// Time for which each motor has been stalled, s, with the sign of pull minus tension.
    duration: [f64; 4],
    /// Angle that each motor has turned since its `duration` began, rad.
    turned: [f64; 4],
    /// Time since the imbalance was last larger than tolerated, s.
    gap: [f64; 4],
}

impl StalledMotor {
    /// `dither_period` is in s, and 0 without dither.
    pub fn new(finger: &ConfiguredFinger, tendons: &Tendons, dither_period: f64) -> Self {
        Self {
            imbalance: Vector4::from(finger.monitors.stall_torque).component_div(&tendons.radius),
            fraction: finger.monitors.stall_fraction,
            friction: MotorFriction::new(finger, tendons),
            longest_gap: dither_period,
        }
    }

    pub fn watch(&self, memory: &mut Memory, sample: &Sample) -> Option<Alarm> {
        for motor in 0..4 {
            let unbalanced = sample.pulls[motor] - sample.tensions[motor];
            let excessive = unbalanced.abs() > self.tolerated(motor, sample);
            if !excessive && memory.duration[motor] == 0.0 {
                continue;
            }
            let turned = memory.turned[motor] + sample.turned[motor];
            let gap = if excessive { 0.0 } else { memory.gap[motor] + sample.elapsed };
            // An excessive imbalance in the other direction restarts the time.
            let reversed = excessive && memory.duration[motor] * unbalanced < 0.0;
            let continues = turned.abs() <= AT_REST && gap <= self.longest_gap && !reversed;
            let added = if excessive { sample.elapsed.copysign(unbalanced) } else { 0.0 };
            memory.duration[motor] = if continues { memory.duration[motor] + added } else { 0.0 };
            memory.turned[motor] = if memory.duration[motor] == 0.0 { 0.0 } else { turned };
            memory.gap[motor] = gap;
        }
        first_of(Symptom::StalledMotor, Part::motor, |motor| {
            (memory.duration[motor].abs() >= DURATION).then(|| sample.pulls[motor] - sample.tensions[motor])
        })
    }

    /// Returns the tolerated difference between pull and tension of a motor, N.
    fn tolerated(&self, motor: usize, sample: &Sample) -> f64 {
        let larger = sample.pulls[motor].abs().max(sample.tensions[motor]);
        let friction = FRICTION * self.friction.at(motor, larger);
        friction.max(self.imbalance[motor] + self.fraction * larger)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::signals::{Feedback, Report};
    use std::f64::consts::TAU;

    const DITHER: f64 = 44.0;

    /// Watches a motor for a second at 1000 Hz. Its mean imbalance of 3 N is tolerated, and the peaks of its dither are
    /// not. `amplitude` is the amplitude of the motor's own oscillation, rad. Returns the time of the first alarm, ms.
    fn alarmed(dither_period: f64, amplitude: f64) -> Option<u32> {
        let finger = ConfiguredFinger::default();
        let monitor = StalledMotor::new(&finger, &finger.tendons().expect("the default tendons"), dither_period);
        let (feedback, report, mut memory) = (Feedback::default(), Report::default(), Memory::default());
        let wave = |millisecond: u32| (TAU * DITHER * 1e-3 * f64::from(millisecond)).sin();
        let tensions = Vector4::repeat(8.0);
        (1..=1000).find(|&now| {
            let sample = Sample {
                feedback: &feedback,
                report: &report,
                tensions,
                travel: Vector4::zeros(),
                turned: Vector4::repeat(amplitude * (wave(now) - wave(now - 1))),
                pulls: tensions.map(|tension| tension - 3.0 - 10.0 * wave(now)),
                elapsed: 1e-3,
                full_scale: 4095,
            };
            monitor.watch(&mut memory, &sample).is_some()
        })
    }

    #[test]
    fn the_peaks_of_a_dither_reveal_a_jammed_motor() {
        let alarmed = alarmed(1.0 / DITHER, 0.0).expect("an alarm");
        // The twelfth sample with an excessive imbalance is in the second peak.
        assert!((23..46).contains(&alarmed), "{alarmed} ms");
    }

    #[test]
    fn a_motor_that_follows_the_dither_is_not_stalled() {
        assert_eq!(alarmed(1.0 / DITHER, 0.04), None);
    }

    #[test]
    fn without_dither_the_imbalance_must_last() {
        assert_eq!(alarmed(0.0, 0.0), None);
    }
}
