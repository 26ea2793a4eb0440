//! Configuration from the joints to the counts on the wire: geometry, motors, sensors, tendons, joint limits.

use serde::{Deserialize, Serialize};

/// `[finger.geometry]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredGeometry {
    /// Link lengths l0, l1, l2, cm.
    pub links: [f64; 3],
    /// R of eq. 14, cm: three rows (joints) with four entries (tendons).
    pub r: [[f64; 4]; 3],
    /// The ghost row of eq. 15. Without it the null vector of R is used.
    pub ghost_row: Option<[f64; 4]>,
    /// Equivalent shaft radius of each motor, cm: tension = torque / radius.
    pub motor_radius: [f64; 4],
}

impl Default for ConfiguredGeometry {
    fn default() -> Self {
        Self {
            links: [3.556, 5.080, 4.000],
            // Entry (2, 4) is -1.09. The report prints +1.09, with which R is singular, but eq. 14 has -r24.
            r: [[-1.09, 0.62, 0.62, -1.09], [1.09, 0.62, -0.62, -1.09], [0.0, 0.62, -0.62, 0.0]],
            ghost_row: None,
            motor_radius: [0.0475; 4],
        }
    }
}

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

/// `[finger.encoder]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredEncoder {
    /// Counts per revolution of the motor.
    pub counts_per_revolution: [u32; 4],
    /// +1 if the count rises as the tendon is pulled in, otherwise -1.
    pub sign: [i8; 4],
    /// m_0 of eq. 28: the count at theta = 0 with the homing pretension.
    pub zero: [i32; 4],
}

impl Default for ConfiguredEncoder {
    fn default() -> Self {
        Self { counts_per_revolution: [2000; 4], sign: [1; 4], zero: [0; 4] }
    }
}

/// `[finger.gauge]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredGauge {
    /// Tension of one count, N.
    pub newton_per_count: [f64; 4],
    /// Count at zero tension.
    pub zero: [f64; 4],
    /// The reference from which identification takes the common scale of the four gauges.
    pub reference: GaugeReference,
}

/// The reference for the common scale of all tensions, which no experiment on a free finger can determine.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum GaugeReference {
    /// The gauges: identification keeps the mean of their configured gains.
    #[default]
    Gauges,
    /// The motors: on average over the four, a motor pulls with its commanded torque minus its friction.
    Motors,
}

impl Default for ConfiguredGauge {
    fn default() -> Self {
        Self { newton_per_count: [100.0 / 4095.0; 4], zero: [0.0; 4], reference: GaugeReference::default() }
    }
}

/// `[finger.tendon]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredTendon {
    /// t_min of eq. 19, N. It is also the homing pretension.
    pub minimum: f64,
    /// t_max, N.
    pub maximum: f64,
    /// Stiffness between motor pulley and joint, N/cm. With it the controller computes the stretch, which the encoders
    /// do not measure.
    pub stiffness: [f64; 4],
    /// Relative uncertainty of `stiffness`. It limits the disagreement of gauges and encoders that is attributed to
    /// `stiffness`. Identification sets it.
    pub stiffness_tolerance: f64,
}

impl Default for ConfiguredTendon {
    fn default() -> Self {
        Self { minimum: 5.0, maximum: 60.0, stiffness: [300.0; 4], stiffness_tolerance: 0.2 }
    }
}

/// `[finger.joints]`
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredJoints {
    /// Lower soft limits, degrees.
    pub minimum_degrees: [f64; 3],
    /// Upper soft limits, degrees.
    pub maximum_degrees: [f64; 3],
}

impl Default for ConfiguredJoints {
    fn default() -> Self {
        Self { minimum_degrees: [-60.0, -30.0, 5.0], maximum_degrees: [60.0, 100.0, 120.0] }
    }
}
