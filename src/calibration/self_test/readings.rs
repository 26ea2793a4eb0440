//! The measurements of one cycle. The angles of the motors are converted to the lengths of tendon that they wind.

use nalgebra::Vector4;

#[derive(Clone, Copy, Debug)]
pub(super) struct Readings {
    /// Travel of each motor since the beginning of the self-test, cm. Positive values pull the tendon in, if the wiring
    /// is right.
    pub travel: Vector4<f64>,
    /// Speed of each motor, cm/s.
    pub speed: Vector4<f64>,
    /// Tensions that the gauges show, N.
    pub tensions: Vector4<f64>,
}
