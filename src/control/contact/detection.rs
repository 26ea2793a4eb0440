//! Decides whether a finger touches something: thresholds with hysteresis, and the slowly varying error of the model.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Force from which a finger at rest touches something, N.
const AT_REST: f64 = 0.07;

/// Increase of this force with the joint rate, N s/rad.
const IN_MOTION: f64 = 0.18;

/// The contact is lost below this part of the force.
const LOST: f64 = 0.6;

/// Torques below which no joint is loaded, N m. They are above the noise of the gauges and the friction of the joints.
const LEAST_TORQUE: f64 = 1e-3;

/// Time constant with which the motion level falls, s.
const CALMING: f64 = 0.15;

/// Time constant of the error of the model, s.
const LEARNING: f64 = 2.0;

/// Duration of the first average of the error of the model, s.
const FIRST: f64 = 0.2;

/// The state of the detection.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(super) struct Detection {
    /// Residual torques of a finger that touches nothing, N m.
    pub error: Vector3<f64>,
    /// Highest joint rate of the recent past, rad/s.
    level: f64,
    /// Time since the start, s. It stops at [`LEARNING`].
    time: f64,
    pub touching: bool,
}

impl Detection {
    /// Decides from the external torques, N m, the force at the tip, N, and the joint rates, rad/s. `residual` is the
    /// torque from which the error is not yet subtracted, N m.
    pub fn decide(&mut self, residual: &Vector3<f64>, force: &Vector3<f64>, rates: &Vector3<f64>, elapsed: f64) {
        self.level = (self.level * (1.0 - elapsed / CALMING)).max(rates.amax());
        let threshold = AT_REST + IN_MOTION * self.level;
        let threshold = if self.touching { threshold * LOST } else { threshold };
        let loaded = (residual - self.error).amax() > LEAST_TORQUE;
        self.touching = self.time >= FIRST && loaded && force.norm_squared() > threshold * threshold;
        if !self.touching {
            self.time = (self.time + elapsed).min(LEARNING);
            self.error += (residual - self.error) * (elapsed / self.time);
        }
    }
}
