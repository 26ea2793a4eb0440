//! What the physics of a simulated finger needs to know and a real finger brings along.

use serde::{Deserialize, Serialize};

/// The parameters of a simulated finger: `[finger.simulation]`. Defaults: chosen to be plausible for a finger of this
/// size driven by small geared motors; nothing was compared with the real hand. SI units, but cm where lengths are
/// geometry.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredSimulation {
    /// Masses of links 0, 1, 2 and of the tip, kg.
    pub masses: [f64; 4],
    /// Radii of the links, uniform cylinders, m.
    pub link_radii: [f64; 3],
    /// Viscous friction of each joint, N m s/rad.
    pub joint_viscous_friction: [f64; 3],
    /// Coulomb friction of each joint, N m. Harsh: 2e-3.
    pub joint_coulomb_friction: [f64; 3],
    /// Stiffness of each tendon between motor pulley and joint, N/cm: what the simulated tendon has. The controller's
    /// belief is `tendon.stiffness`; they differ where an experiment wants them to.
    pub tendon_stiffness: [f64; 4],
    /// Inertia of each rotor, kg m^2.
    pub rotor_inertia: [f64; 4],
    /// Viscous friction of each motor, N m s/rad.
    pub motor_viscous_friction: [f64; 4],
    /// Coulomb friction of each motor, N m.
    pub motor_coulomb_friction: [f64; 4],
    /// Conduit friction: this part of the tension torque adds to the motor's Coulomb friction.
    pub conduit_friction: f64,
    /// True motor torque over commanded torque; 1 is a motor with the constant of its data sheet.
    pub motor_constant_ratio: [f64; 4],
    /// Noise of the strain gauges, N rms.
    pub gauge_noise: f64,
    /// How far beyond the soft limits the mechanical stops are, degrees.
    pub stop_margin_degrees: f64,
    /// Pose at start, degrees.
    pub start_degrees: [f64; 3],
    /// Seed of everything random.
    pub seed: u64,
    /// Something to touch, if any.
    pub surface: Option<Surface>,
}

/// Something that a simulated fingertip can touch: frictionless and elastic. In the finger's frame, cm and N/cm.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Surface {
    /// A flat wall through `point`; `normal` points to the finger's side.
    Wall {
        /// A point of the wall, cm.
        point: [f64; 3],
        /// Outward normal, of any length but zero.
        normal: [f64; 3],
        /// N/cm.
        stiffness: f64,
    },
    /// A ball that does not move.
    Ball {
        /// Centre, cm.
        centre: [f64; 3],
        /// Radius, cm.
        radius: f64,
        /// N/cm.
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
