//! Detects encoders that move farther than their motors can.

use super::alarm::{Alarm, Symptom, first_of};
use super::sample::Sample;
use crate::model::Part;
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;
use std::f64::consts::TAU;

/// Factor for the uncertainty of the largest acceleration. The acceleration follows from the torque limit of the motor,
/// the maximum tension of its tendon and the rotor inertia.
const MARGIN: f64 = 1.25;

/// Additional tolerance, counts. The check compares two differences of two counts each, and the last bit of each count
/// may flicker.
const FLICKER: f64 = 4.0;

/// Shortest interval over which a speed is measured, as a fraction of a period. A late cycle is followed immediately by
/// the next one, and the motor hardly turns between them. Over such a short interval, a change of the last bit alone
/// would appear as a high speed.
const SHORTEST: f64 = 0.75;

#[derive(Clone, Debug)]
pub(super) struct EncoderJump {
    /// Shortest interval over which a speed is measured, s.
    shortest: f64,
    /// Largest acceleration of each motor, rad/s^2.
    strongest: Vector4<f64>,
    counts_per_radian: Vector4<f64>,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Memory {
    /// Angle that each motor has turned since the last measurement of the speed, rad.
    turned: Vector4<f64>,
    /// Time since the last measurement of the speed, s.
    elapsed: f64,
    /// The last measured speed, rad/s, and the interval over which it was measured, s.
    speed: Option<(Vector4<f64>, f64)>,
}

impl EncoderJump {
    pub fn new(finger: &ConfiguredFinger, period: f64) -> Self {
        let inertia = Vector4::from(finger.motor.inertia);
        let pulled = Vector4::from(finger.geometry.motor_radius) * finger.tendon.maximum;
        // 1 N cm = 0.01 N m.
        let torque = (Vector4::from(finger.motor.torque_limit) + pulled) * 0.01;
        Self {
            shortest: SHORTEST * period,
            strongest: torque.component_div(&inertia) * MARGIN,
            counts_per_radian: Vector4::from(finger.encoder.counts_per_revolution.map(f64::from)) / TAU,
        }
    }

    pub fn watch(&self, memory: &mut Memory, sample: &Sample) -> Option<Alarm> {
        memory.turned += sample.turned;
        memory.elapsed += sample.elapsed;
        if memory.elapsed < self.shortest {
            return None;
        }
        let (turned, elapsed) = (std::mem::take(&mut memory.turned), std::mem::take(&mut memory.elapsed));
        let (before, interval) = memory.speed.replace((turned / elapsed, elapsed))?;
        // Both speeds are means, so the speed may have changed during both intervals. After lost replies the first
        // interval is much longer than the second.
        let mean_interval = 0.5 * (interval.max(elapsed) + elapsed);
        first_of(Symptom::EncoderJump, Part::encoder, |encoder| {
            let unexpected = (turned[encoder] - before[encoder] * elapsed) * self.counts_per_radian[encoder];
            let possible = 2.0 * self.strongest[encoder] * (elapsed * mean_interval) * self.counts_per_radian[encoder];
            (unexpected.abs() > possible + FLICKER).then_some(unexpected)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::signals::{Feedback, Report};

    const PERIOD: f64 = 1e-3;

    /// Watches motors that start from rest and keep the acceleration of the largest torque. `intervals` are the times
    /// between the samples, periods. In the last interval, the first encoder gains `jump` counts.
    fn alarmed(intervals: &[f64], jump: f64) -> bool {
        let monitor = EncoderJump::new(&ConfiguredFinger::default(), PERIOD);
        let acceleration = monitor.strongest / MARGIN;
        let (feedback, report, mut memory) = (Feedback::default(), Report::default(), Memory::default());
        let (mut time, mut alarmed) = (0.0f64, false);
        for (number, periods) in intervals.iter().enumerate() {
            let (before, elapsed) = (time, periods * PERIOD);
            time += elapsed;
            let mut turned = acceleration * (0.5 * (time * time - before * before));
            if number + 1 == intervals.len() {
                turned[0] += jump / monitor.counts_per_radian[0];
            }
            let sample = Sample {
                feedback: &feedback,
                report: &report,
                tensions: Vector4::zeros(),
                travel: Vector4::zeros(),
                turned,
                pulls: Vector4::zeros(),
                elapsed,
                full_scale: 4095,
            };
            alarmed |= monitor.watch(&mut memory, &sample).is_some();
        }
        alarmed
    }

    #[test]
    fn an_acceleration_during_lost_replies_is_no_jump() {
        assert!(!alarmed(&[1.0, 1.0, 10.0, 1.0, 1.0], 0.0));
    }

    #[test]
    fn a_jump_is_detected_with_and_without_lost_replies() {
        assert!(!alarmed(&[1.0, 1.0, 1.0, 1.0], 0.0));
        assert!(alarmed(&[1.0, 1.0, 1.0, 1.0], 200.0));
        assert!(alarmed(&[1.0, 1.0, 10.0, 1.0, 1.0, 1.0], 200.0));
    }
}
