//! Detects warm and overheated motors by their heat, which is the filtered mean square of the torque. The continuous
//! heat of a motor is the square of its continuous torque.

use super::alarm::{Alarms, Symptom, first_of};
use super::sample::Sample;
use crate::model::Part;
use crate::model::configuration::ConfiguredFinger;
use nalgebra::Vector4;

/// Fraction of the continuous heat from which a motor counts as warm. Its torque is limited from there on.
const WARM: f64 = 0.8;

/// Fraction of the continuous heat from which a motor counts as hot.
const HOT: f64 = 0.95;

#[derive(Clone, Debug)]
pub(super) struct MotorHeat {
    /// Time that a motor may stay hot, s. It equals the thermal time constant.
    time_limit: f64,
}

/// Time for which each motor has been hot, s.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Memory([f64; 4]);

impl MotorHeat {
    pub fn new(finger: &ConfiguredFinger) -> Self {
        Self { time_limit: finger.motor.thermal_time }
    }

    /// Returns the alarms. `heat` is the heat of each motor as a fraction of its continuous heat.
    pub fn watch(&self, memory: &mut Memory, heat: &Vector4<f64>, sample: &Sample) -> Alarms {
        for motor in 0..4 {
            memory.0[motor] = if heat[motor] > HOT { memory.0[motor] + sample.elapsed } else { 0.0 };
        }
        let percent = |motor: usize| 100.0 * heat[motor];
        let too_long = |motor: usize| (memory.0[motor] > self.time_limit).then(|| percent(motor));
        Alarms {
            fault: first_of(Symptom::OverheatedMotor, Part::motor, too_long),
            warning: first_of(Symptom::WarmMotor, Part::motor, |motor| (heat[motor] > WARM).then(|| percent(motor))),
        }
    }
}
