//! Parameters for the physics of a simulated finger.

use super::named_hand::NamedHand;
use serde::{Deserialize, Serialize};

/// The parameters of a simulated finger: `[finger.simulation]`. The defaults are plausible for a finger of this size
/// with small geared motors. No value was compared with the real hand. Units are SI, except that stiffnesses are in
/// N/cm, the lengths of a surface in cm, angles in degrees, and the delay and lag of the amplifiers in ms.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredSimulation {
    /// The named hand that gives the values of the keys that a configuration file omits. In Rust, this field only
    /// records the name: [`Self::named`] constructs the values.
    pub hand: NamedHand,
    /// Masses of links 0, 1, 2 and of the tip, kg.
    pub masses: [f64; 4],
    /// Mass of an object that the tip holds, kg.
    pub held_mass: f64,
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
    /// Friction of each motor shaft: this fraction of the tendon's torque on the motor is added to the motor's Coulomb
    /// friction.
    pub shaft_friction: f64,
    /// Friction of each conduit, between motor and gauge: the largest difference between the tensions on its two
    /// sides, as a fraction of the smaller one.
    pub conduit_friction: f64,
    /// Friction of the pulleys of each tendon, between gauge and joint, as a fraction of the tension.
    pub pulley_friction: f64,
    /// Static friction of motors and joints, divided by their Coulomb friction. As the speed rises, the friction falls
    /// to the Coulomb friction (Stribeck curve).
    pub stiction_ratio: f64,
    /// Hardening h of the tendons, 0 to 0.9. The local stiffness is (1 - h) `tendon_stiffness` without tension, and
    /// rises linearly with the tension to (1 + h) `tendon_stiffness` at `tendon.maximum`.
    pub hardening: f64,
    /// Creep of the tendons: the length that creep adds in the long run, divided by the elastic stretch.
    pub creep: f64,
    /// Time constant of the creep, s.
    pub creep_time: f64,
    /// True moment arms divided by `geometry.r`, entry by entry.
    pub moment_arm_ratio: [[f64; 4]; 3],
    /// True motor torque divided by the commanded torque. It is 1 for a motor with the torque constant of its data
    /// sheet.
    pub motor_constant_ratio: [f64; 4],
    /// Ripple of the motor torque, as a fraction of the torque. It has seven periods in a revolution.
    pub torque_ripple: f64,
    /// Time constant of the amplifiers' first-order lag, ms.
    pub amplifier_lag_ms: f64,
    /// Dead time between a command and the torque, in addition to that of the board, ms.
    pub command_delay_ms: f64,
    /// Tension that each gauge shows, divided by the true one.
    pub gauge_gain_ratio: [f64; 4],
    /// Error of each gauge that does not depend on the tension, N.
    pub gauge_offset: [f64; 4],
    /// Cut-off frequency of the gauges' first-order low-pass, Hz. 0: no low-pass.
    pub gauge_bandwidth: f64,
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
            hand: NamedHand::Nominal,
            masses: [0.060, 0.045, 0.025, 0.005],
            held_mass: 0.0,
            link_radii: [0.009, 0.008, 0.007],
            joint_viscous_friction: [5e-4; 3],
            joint_coulomb_friction: [0.5e-3; 3],
            tendon_stiffness: [300.0; 4],
            rotor_inertia: [6e-7; 4],
            motor_viscous_friction: [2e-6; 4],
            motor_coulomb_friction: [0.7e-3; 4],
            shaft_friction: 0.05,
            conduit_friction: 0.0,
            pulley_friction: 0.0,
            stiction_ratio: 1.0,
            hardening: 0.0,
            creep: 0.0,
            creep_time: 30.0,
            moment_arm_ratio: [[1.0; 4]; 3],
            motor_constant_ratio: [1.0; 4],
            torque_ripple: 0.0,
            amplifier_lag_ms: 0.0,
            command_delay_ms: 0.0,
            gauge_gain_ratio: [1.0; 4],
            gauge_offset: [0.0; 4],
            gauge_bandwidth: 0.0,
            gauge_noise: 0.03,
            stop_margin_degrees: 3.0,
            start_degrees: [0.0, 30.0, 60.0],
            seed: 1990,
            surface: None,
        }
    }
}
