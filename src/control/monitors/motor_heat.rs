//! Motors that are warm, by the square of their torque over time.

use super::alarm::{Alarms, Symptom, first_of};
use super::sample::Sample;
use crate::model::Part;
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;

/// Part of the heat that a motor bears for ever from which on it is warm: its torque is being limited.
const WARM: f64 = 0.8;

/// From this part on it is at the limit.
const HOT: f64 = 0.95;

#[derive(Clone, Debug)]
pub(super) struct MotorHeat {
    /// How long a motor may be at the limit, s: as long as it takes to cool.
    bearable: f64,
}

/// For how long each motor has been hot, s.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Memory([f64; 4]);

impl MotorHeat {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        Self { bearable: finger.motor.thermal_time }
    }

    /// `heat`: part of the heat that each motor bears for ever.
    pub fn watch(&self, memory: &mut Memory, heat: &Vector4<f64>, sample: &Sample) -> Alarms {
        for motor in 0..4 {
            memory.0[motor] = if heat[motor] > HOT { memory.0[motor] + sample.elapsed } else { 0.0 };
        }
        let percent = |motor: usize| 100.0 * heat[motor];
        let too_long = |motor: usize| (memory.0[motor] > self.bearable).then(|| percent(motor));
        Alarms {
            fault: first_of(Symptom::OverheatedMotor, Part::motor, too_long),
            warning: first_of(Symptom::WarmMotor, Part::motor, |motor| (heat[motor] > WARM).then(|| percent(motor))),
        }
    }
}
