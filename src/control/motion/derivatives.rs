//! The motion of a set point: the first four derivatives of its joint angles.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// The motion of a set point at one instant. State feedback feeds all four derivatives forward, because the motor
/// torque of an elastic finger depends on the fourth one. The controllers of Figures 9 to 11 of the report
/// (COINS TR 90-48) use only the rates.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Serialize)]
pub struct Motion {
    /// Joint rates, rad/s.
    pub rates: Vector3<f64>,
    /// Joint accelerations, rad/s^2.
    pub accelerations: Vector3<f64>,
    /// Third derivative of the joint angles, rad/s^3.
    pub jerk: Vector3<f64>,
    /// Fourth derivative of the joint angles, rad/s^4.
    pub snap: Vector3<f64>,
}
