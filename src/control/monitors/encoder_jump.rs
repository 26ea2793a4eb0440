//! Encoders that move farther than their motors can.

use super::{Alarm, Sample, Symptom, first_of};
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;
use std::f64::consts::TAU;

/// Motor torque and the pull of the strongest tendon, over the rotor's inertia, are known to this factor.
const MARGIN: f64 = 1.25;

/// Counts beside that: the last bit flickers at both ends of two differences.
const FLICKER: f64 = 4.0;

#[derive(Clone, Debug)]
pub(super) struct EncoderJump {
    /// Largest change of speed, rad/s^2.
    strongest: Vector4<f64>,
    counts_per_radian: Vector4<f64>,
}

/// Speed over the last sample, rad/s.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Memory {
    speed: Option<Vector4<f64>>,
}

impl EncoderJump {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        let inertia = Vector4::from(finger.motor.inertia);
        let pulled = Vector4::from(finger.geometry.motor_radius) * finger.tendon.maximum;
        // 1 N cm = 0.01 N m.
        let torque = (Vector4::from(finger.motor.torque_limit) + pulled) * 0.01;
        Self {
            strongest: torque.component_div(&inertia) * MARGIN,
            counts_per_radian: Vector4::from(finger.encoder.counts_per_revolution.map(f64::from)) / TAU,
        }
    }

    pub fn watch(&self, memory: &mut Memory, sample: &Sample) -> Option<Alarm> {
        let speed = sample.turned / sample.elapsed;
        let before = memory.speed.replace(speed)?;
        first_of(Symptom::EncoderJump, |encoder| {
            let unexpected =
                (sample.turned[encoder] - before[encoder] * sample.elapsed) * self.counts_per_radian[encoder];
            // Both speeds are means: the change had up to two intervals of this length.
            let possible = 2.0 * self.strongest[encoder] * sample.elapsed.powi(2) * self.counts_per_radian[encoder];
            (unexpected.abs() > possible + FLICKER).then_some(unexpected)
        })
    }
}
