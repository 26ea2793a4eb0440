//! The set point as the finger can follow it: smooth enough that its derivatives can be fed forward.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Poles of the filter.
const ORDER: usize = 5;

/// Five equal first-order stages s in a row: the motor torque of an elastic finger depends on the fourth derivative of
/// where the joints shall be (snap), and a filter of order n makes the derivative n - 1 continuous.
///
/// The filter works on joint angles, not on the tip: joint rates are then there without J^-1, which has no bound.
#[derive(Clone, Debug)]
pub(crate) struct Reference {
    /// What a stage moves by in a cycle.
    gain: f64,
    /// Of a stage, s.
    time: f64,
}

/// The stages, rad.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(crate) struct ReferenceState([Vector3<f64>; ORDER]);

/// Joint angles and their four derivatives, rad/s^n.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReferenceMotion {
    pub joints: Vector3<f64>,
    pub rates: Vector3<f64>,
    pub accelerations: Vector3<f64>,
    pub jerk: Vector3<f64>,
    pub snap: Vector3<f64>,
}

impl Reference {
    /// Time constant of each stage, s; cycles a second.
    pub fn new(time: f64, rate: f64) -> Self {
        Self { gain: -(-1.0 / (time * rate)).exp_m1(), time }
    }

    /// At rest.
    pub fn start(&self, joints: &Vector3<f64>) -> ReferenceState {
        ReferenceState([*joints; ORDER])
    }

    /// Moves on by one cycle toward `target`, rad.
    pub fn advance(&self, state: &mut ReferenceState, target: &Vector3<f64>) -> ReferenceMotion {
        let mut input = *target;
        for stage in &mut state.0 {
            *stage += (input - *stage) * self.gain;
            input = *stage;
        }
        // x_n' = (x_(n-1) - x_n) / time, again and again.
        let [first, second, third, fourth, last] = state.0;
        let per = 1.0 / self.time;
        ReferenceMotion {
            joints: last,
            rates: (fourth - last) * per,
            accelerations: (third - fourth * 2.0 + last) * per.powi(2),
            jerk: (second - third * 3.0 + fourth * 3.0 - last) * per.powi(3),
            snap: (first - second * 4.0 + third * 6.0 - fourth * 4.0 + last) * per.powi(4),
        }
    }
}
