//! Parameters for the physics of a simulated finger.

use serde::{Deserialize, Serialize};

/// The parameters of a simulated finger: `[finger.simulation]`. The defaults are plausible for a finger of this size
/// with small geared motors. No value was compared with the real hand. Units are SI, except that stiffnesses are in
/// N/cm, the lengths of a surface in cm, and angles in degrees.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredSimulation {
    /// Masses of links 0, 1, 2 and of the tip, kg.
    pub masses: [f64; 4],
    /// Radii of the links, m. The links are uniform cylinders.
    pub link_radii: [f64; 3],
    /// Viscous friction of each joint, N m s/rad.
    pub joint_viscous_friction: [f64; 3],
    /// Coulomb friction of each joint, N m. A joint with much friction has 2e-3.
    pub joint_coulomb_friction: [f64; 3],
    /// True stiffness of each simulated tendon between motor pulley and joint, N/cm. The controller uses
    /// `tendon.stiffness` instead. Experiments with a wrong stiffness set the two to different values.
    pub tendon_stiffness: [f64; 4],
    /// Inertia of each rotor, kg m^2.
    pub rotor_inertia: [f64; 4],
    /// Viscous friction of each motor, N m s/rad.
    pub motor_viscous_friction: [f64; 4],
    /// Coulomb friction of each motor, N m.
    pub motor_coulomb_friction: [f64; 4],
    /// Conduit friction: the fraction of the tension torque that is added to the motor's Coulomb friction.
    pub conduit_friction: f64,
    /// True motor torque divided by the commanded torque. It is 1 for a motor with the torque constant of its data
    /// sheet.
    pub motor_constant_ratio: [f64; 4],
    /// Noise of the strain gauges, N rms.
    pub gauge_noise: f64,
    /// Distance of the mechanical stops beyond the soft limits, degrees.
    pub stop_margin_degrees: f64,
    /// Joint angles at the start, degrees.
    pub start_degrees: [f64; 3],
    /// Seed of all random numbers.
    pub seed: u64,
    /// Surface that the fingertip can touch, if any.
    pub surface: Option<Surface>,
}

/// An elastic surface without friction that a simulated fingertip can touch, in the finger's frame.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Surface {
    /// A flat wall through `point`. `normal` points to the side of the finger.
    Wall {
        /// A point of the wall, cm.
        point: [f64; 3],
        /// Outward normal. Its length must not be zero.
        normal: [f64; 3],
        /// Stiffness, N/cm.
        stiffness: f64,
    },
    /// A fixed ball.
    Ball {
        /// Centre, cm.
        centre: [f64; 3],
        /// Radius, cm.
        radius: f64,
        /// Stiffness, N/cm.
        stiffness: f64,
    },
}

impl Default for ConfiguredSimulation {
    fn default() -> Self {
        Self {
            masses: [0.060, 0.045, 0.025, 0.005],
            link_radii: [0.009, 0.008, 0.007],
            joint_viscous_friction: [5e-4; 3],
            joint_coulomb_friction: [0.5e-3; 3],
            tendon_stiffness: [300.0; 4],
            rotor_inertia: [6e-7; 4],
            motor_viscous_friction: [2e-6; 4],
            motor_coulomb_friction: [0.7e-3; 4],
            conduit_friction: 0.05,
            motor_constant_ratio: [1.0; 4],
            gauge_noise: 0.03,
            stop_margin_degrees: 3.0,
            start_degrees: [0.0, 30.0, 60.0],
            seed: 1990,
            surface: None,
        }
    }
}
