//! Change of activity or controller without a jump in torque.

use nalgebra::Vector4;
use serde::{Deserialize, Serialize};

/// Time constant with which the old command fades, s.
const FADE: f64 = 0.02;

/// Difference between the command and the output of the controller, N at the tendon. It decays to zero.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(crate) struct BumplessTransfer {
    rest: Vector4<f64>,
}

impl BumplessTransfer {
    /// Starts a transfer: the command starts at `before` and fades to `asked`.
    pub fn begin(&mut self, before: &Vector4<f64>, asked: &Vector4<f64>) {
        self.rest = before - asked;
    }

    /// Returns the pulls that are added to the output of the controller in this cycle, N.
    pub fn advance(&mut self, period: f64) -> Vector4<f64> {
        let rest = self.rest;
        self.rest -= rest * (period / FADE).min(1.0);
        rest
    }
}
