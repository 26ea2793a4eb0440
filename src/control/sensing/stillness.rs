//! Whether the motors have come to rest. A speed cannot tell: at 1000 Hz a single count is already 3 rad/s.

use nalgebra::Vector4;
use serde::{Deserialize, Serialize};

/// Seconds that the motors must stay where they are.
const REST: f64 = 0.05;

/// How far a resting motor may wander, rad: the last bit of an encoder flickers.
const WANDER: f64 = 0.007;

/// Where the motors were, and for how long.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct Stillness {
    at: Vector4<f64>,
    seconds: f64,
}

impl Stillness {
    pub fn new(motor_angles: Vector4<f64>) -> Self {
        Self { at: motor_angles, seconds: 0.0 }
    }

    /// Notes the angles, rad, `period` seconds after the last ones.
    pub fn note(&mut self, motor_angles: &Vector4<f64>, period: f64) {
        if (motor_angles - self.at).amax() <= WANDER {
            self.seconds += period;
        } else {
            *self = Self::new(*motor_angles);
        }
    }

    pub fn at_rest(&self) -> bool {
        self.seconds >= REST
    }
}
