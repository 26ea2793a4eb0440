//! Detects motors that do not turn although pull and tension are not balanced.

use super::alarm::{Alarm, Symptom, first_of};
use super::sample::Sample;
use crate::control::motors::motor_friction::MotorFriction;
use crate::model::configuration::ConfiguredFinger;
use crate::model::{Part, Tendons};

/// Tolerated imbalance as a multiple of the configured friction. It is more than 1 because friction is known poorly.
const FRICTION: f64 = 3.0;

/// Additional tolerance as a fraction of the pull or of the tension, whichever is larger. It allows for the error of
/// the torque constant.
const TORQUE_CONSTANT: f64 = 0.3;

/// Additional tolerance, N.
const TOLERANCE: f64 = 1.0;

/// Time for which the imbalance must last, s. In this time a free motor would turn by dozens of counts under the
/// smallest imbalance that this monitor reports.
const DURATION: f64 = 0.012;

/// Largest motion of a motor that is considered to be at rest, rad. The last bit of an encoder flickers.
const AT_REST: f64 = 0.007;

#[derive(Clone, Debug)]
pub(super) struct StalledMotor {
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
        Self { friction: MotorFriction::new(finger, tendons) }
    }

    pub fn watch(&self, memory: &mut Memory, sample: &Sample) -> Option<Alarm> {
        for motor in 0..4 {
            let unbalanced = sample.pulls[motor] - sample.tensions[motor];
            let larger = sample.pulls[motor].abs().max(sample.tensions[motor]);
            let friction = FRICTION * self.friction.at(motor, larger);
            let held = friction + TORQUE_CONSTANT * larger + TOLERANCE;
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
