//! Changing what a finger does without a jump in torque.

use nalgebra::Vector4;
use serde::{Deserialize, Serialize};

/// Time constant with which the old command fades, s.
const FADE: f64 = 0.02;

/// What the commands still differ by from what the controller asks for, N at the tendon.
#[derive(Clone, Copy, Debug, Default, Deserialize, Serialize)]
pub(crate) struct BumplessTransfer {
    rest: Vector4<f64>,
}

impl BumplessTransfer {
    /// From here on the command starts at `before` and fades to what is `asked`.
    pub fn begin(&mut self, before: &Vector4<f64>, asked: &Vector4<f64>) {
        self.rest = before - asked;
    }

    /// What is added to the pulls of this cycle, N.
    pub fn advance(&mut self, period: f64) -> Vector4<f64> {
        let rest = self.rest;
        self.rest -= rest * (period / FADE).min(1.0);
        rest
    }
}
