//! `[finger.motor]`: signs, limits and constants of the motors.

use serde::{Deserialize, Serialize};

/// `[finger.motor]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredMotor {
    /// +1 if a positive command pulls the tendon, otherwise -1.
    pub sign: [i8; 4],
    /// Largest torque of each motor, N cm.
    pub torque_limit: [f64; 4],
    /// Torque constant, N cm/A. The host sends it to the board, which converts torque to current.
    pub torque_constant: [f64; 4],
    /// Inertia of each rotor including its gear, kg m^2.
    pub inertia: [f64; 4],
    /// Viscous friction of each motor, N m s/rad.
    pub viscous_friction: [f64; 4],
    /// Torque that each motor can give continuously, N cm.
    pub continuous_torque: [f64; 4],
    /// Thermal time constant of the motors, s.
    pub thermal_time: f64,
}

impl Default for ConfiguredMotor {
    fn default() -> Self {
        Self {
            sign: [1; 4],
            torque_limit: [4.75; 4],
            torque_constant: [2.34; 4],
            inertia: [6e-7; 4],
            viscous_friction: [2e-6; 4],
            continuous_torque: [2.5; 4],
            thermal_time: 15.0,
        }
    }
}
