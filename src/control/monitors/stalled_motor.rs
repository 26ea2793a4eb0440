//! Detects motors that do not turn although pull and tension are not balanced.

use super::alarm::{Alarm, Symptom, first_of};
use super::sample::Sample;
use crate::control::motors::motor_friction::MotorFriction;
use crate::model::configuration::ConfiguredFinger;
use crate::model::{Part, Tendons};
use nalgebra::Vector4;

/// Smallest tolerated imbalance as a multiple of the configured friction. It matters only for motors with more friction
/// than the thresholds allow for: friction that is configured lower must not make the monitor more sensitive.
const FRICTION: f64 = 1.5;

/// Time for which the imbalance must last, s. In this time a free motor would turn by dozens of counts under the
/// smallest imbalance that this monitor reports.
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
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Memory {
    /// Time for which each motor has been stalled, s, with the sign of pull minus tension.
    duration: [f64; 4],
    /// Angle that each motor has turned in this time, rad.
    turned: [f64; 4],
}

impl StalledMotor {
    pub fn new(finger: &ConfiguredFinger, tendons: &Tendons) -> Self {
        Self {
            imbalance: Vector4::from(finger.monitors.stall_torque).component_div(&tendons.radius),
            fraction: finger.monitors.stall_fraction,
            friction: MotorFriction::new(finger, tendons),
        }
    }

    pub fn watch(&self, memory: &mut Memory, sample: &Sample) -> Option<Alarm> {
        for motor in 0..4 {
            let unbalanced = sample.pulls[motor] - sample.tensions[motor];
            let larger = sample.pulls[motor].abs().max(sample.tensions[motor]);
            let friction = FRICTION * self.friction.at(motor, larger);
            let held = friction.max(self.imbalance[motor] + self.fraction * larger);
            let turned = memory.turned[motor] + sample.turned[motor];
            let stalled = unbalanced.abs() > held && turned.abs() <= AT_REST;
            // An imbalance that changes its sign, such as that of a dither, restarts the time.
            let continues = stalled && memory.duration[motor] * unbalanced >= 0.0;
            memory.duration[motor] =
                if continues { memory.duration[motor] + sample.elapsed.copysign(unbalanced) } else { 0.0 };
            memory.turned[motor] = if continues { turned } else { 0.0 };
        }
        first_of(Symptom::StalledMotor, Part::motor, |motor| {
            (memory.duration[motor].abs() >= DURATION).then(|| sample.pulls[motor] - sample.tensions[motor])
        })
    }
}
