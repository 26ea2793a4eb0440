//! The measurements of a cycle, in the units of the tendons.

use nalgebra::Vector4;

#[derive(Clone, Copy, Debug)]
pub(super) struct Readings {
    /// Travel of each motor since the beginning, cm. Positive values pull the tendon in, if the wiring is right.
    pub travel: Vector4<f64>,
    /// Speed of each motor, cm/s.
    pub speed: Vector4<f64>,
    /// Tensions that the gauges show, N.
    pub tensions: Vector4<f64>,
}
