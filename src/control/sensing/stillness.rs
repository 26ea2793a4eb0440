//! Detects that the motors are at rest. A measured speed cannot show this, because a change of a single count in one
//! cycle at 1000 Hz is already a speed of 3 rad/s.

use nalgebra::Vector4;
use serde::{Deserialize, Serialize};

/// Time for which the motors must keep their position, s.
const REST: f64 = 0.05;

/// Largest motion of a motor that is considered to be at rest, rad. It is just above two counts of the default encoder,
/// because the last bit of an encoder flickers.
const LARGEST_MOTION: f64 = 0.007;

/// The position of the motors, and the time for which they have kept it.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct Stillness {
    at: Vector4<f64>,
    seconds: f64,
}

impl Stillness {
    pub fn new(motor_angles: Vector4<f64>) -> Self {
        Self { at: motor_angles, seconds: 0.0 }
    }

    /// Records motor angles, rad, that were measured `period` seconds after the previous ones.
    #[inline]
    pub fn note(&mut self, motor_angles: &Vector4<f64>, period: f64) {
        if (motor_angles - self.at).amax() <= LARGEST_MOTION {
            self.seconds += period;
        } else {
            *self = Self::new(*motor_angles);
        }
    }

    pub fn at_rest(&self) -> bool {
        self.seconds >= REST
    }
}
