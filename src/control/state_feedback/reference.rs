//! The reference of the joints: the set point, filtered so that its derivatives can be fed forward.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Number of poles of the filter.
const ORDER: usize = 5;

/// Five equal first-order stages in series. The motor torque of an elastic finger depends on the fourth derivative of
/// the reference (snap). A filter of order n makes the derivative n - 1 continuous.
///
/// The filter acts on joint angles and not on the tip. So the joint rates follow without J^-1, which is unbounded.
#[derive(Clone, Debug)]
pub(crate) struct Reference {
    /// Fraction of the remaining difference by which a stage moves in a cycle.
    gain: f64,
    /// Time constant of a stage, s.
    time: f64,
}

/// Outputs of the stages, rad.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(crate) struct ReferenceState([Vector3<f64>; ORDER]);

/// Joint angles, rad, and their first four derivatives, rad/s^n.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ReferenceMotion {
    pub joints: Vector3<f64>,
    pub rates: Vector3<f64>,
    pub accelerations: Vector3<f64>,
    pub jerk: Vector3<f64>,
    pub snap: Vector3<f64>,
}

impl Reference {
    /// Constructs the filter from the time constant of each stage, s, and the rate, Hz.
    pub fn new(time: f64, rate: f64) -> Self {
        Self { gain: -(-1.0 / (time * rate)).exp_m1(), time }
    }

    /// Returns the state of a reference at rest.
    pub fn start(&self, joints: &Vector3<f64>) -> ReferenceState {
        ReferenceState([*joints; ORDER])
    }

    /// Advances the reference by one cycle toward `target`, rad.
    pub fn advance(&self, state: &mut ReferenceState, target: &Vector3<f64>) -> ReferenceMotion {
        let mut input = *target;
        for stage in &mut state.0 {
            *stage += (input - *stage) * self.gain;
            input = *stage;
        }
        // Each derivative follows from x_n' = (x_(n-1) - x_n) / time.
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
