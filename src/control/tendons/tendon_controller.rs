//! The tendon controller converts desired tensions to pulls of the motors, by the selected figure of the report.

use crate::control::tendons::figure9::Figure9;
use crate::control::tendons::figure10::Figure10;
use crate::control::tendons::figure11::Figure11;
use crate::control::tendons::gains::Gains;
use crate::control::tendons::tension_integral::{TendonInput, TendonState, TensionIntegral};
use crate::model::configuration::Scheme;
use nalgebra::Vector4;

/// The selected scheme. All schemes have the same input, state and result. The result is the pull at each tendon, N. It
/// is within the limits of the motors.
#[derive(Clone, Debug)]
pub(crate) enum TendonController {
    Figure9(Figure9),
    Figure10(Figure10),
    Figure11(Figure11),
}

impl TendonController {
    pub fn new(scheme: Scheme, gains: &Gains, rate: f64) -> Self {
        let integral = TensionIntegral::new(gains.tension_integral, rate);
        let motor_damping = gains.motor_damping;
        match scheme {
            Scheme::Figure9 => Self::Figure9(Figure9 { integral, motor_damping }),
            Scheme::Figure10 | Scheme::StateFeedback => {
                Self::Figure10(Figure10 { integral, tension_gain: gains.tension_gain, motor_damping })
            }
            Scheme::Figure11 => Self::Figure11(Figure11::new(gains.adaptation_gain, motor_damping, rate)),
        }
    }

    /// Returns the pulls, N.
    pub fn pulls(&self, state: &mut TendonState, input: &TendonInput) -> Vector4<f64> {
        match self {
            Self::Figure9(scheme) => scheme.pulls(state, input),
            Self::Figure10(scheme) => scheme.pulls(state, input),
            Self::Figure11(scheme) => scheme.pulls(state, input),
        }
    }
}
