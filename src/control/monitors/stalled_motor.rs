//! Motors that do not turn although something should turn them.

use super::alarm::{Alarm, Symptom, first_of};
use super::sample::Sample;
use crate::control::motors::motor_friction::MotorFriction;
use crate::model::configuration::ConfiguredFinger;
use crate::model::{Part, Tendons};

/// Out-of-balance that friction may hold: the configured friction so many times, because it is known badly, and this
/// part of the pull, for the error of the torque constant.
const FRICTION: f64 = 3.0;
const TORQUE_CONSTANT: f64 = 0.3;

/// N, besides.
const LET_PASS: f64 = 1.0;

/// So long, s: a free motor under the least of it would have turned by dozens of counts.
const LASTS: f64 = 0.012;

/// rad; the last bit of an encoder flickers.
const AT_REST: f64 = 0.007;

#[derive(Clone, Debug)]
pub(super) struct StalledMotor {
    friction: MotorFriction,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Memory {
    /// For how long, s, with the sign of pull minus tension, and how far each motor has turned since, rad.
    lasts: [f64; 4],
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
            let held = friction + TORQUE_CONSTANT * larger + LET_PASS;
            let turned = memory.turned[motor] + sample.turned[motor];
            let stands = unbalanced.abs() > held && turned.abs() <= AT_REST;
            // To and fro, as a dither goes, cancels out.
            let goes_on = stands && memory.lasts[motor] * unbalanced >= 0.0;
            memory.lasts[motor] = if goes_on { memory.lasts[motor] + sample.elapsed.copysign(unbalanced) } else { 0.0 };
            memory.turned[motor] = if goes_on { turned } else { 0.0 };
        }
        first_of(Symptom::StalledMotor, Part::motor, |motor| {
            (memory.lasts[motor].abs() >= LASTS).then(|| sample.pulls[motor] - sample.tensions[motor])
        })
    }
}
