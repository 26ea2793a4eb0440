//! `[finger.friction]`: the controller's model of the friction of a finger. The true values of the simulated finger are
//! in `[finger.simulation]`. The defaults of this table describe the default simulated finger. `conduit` corresponds to
//! `simulation.shaft_friction`. An experiment with a wrong model sets different values in the two tables.

use serde::{Deserialize, Serialize};

/// `[finger.friction]`: friction that the controller compensates.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredFriction {
    /// Coulomb friction of each motor, N cm of commanded torque.
    pub motor_coulomb: [f64; 4],
    /// Conduit friction: this fraction of the tendon's torque on its motor (tension times `geometry.motor_radius`) is
    /// added to `motor_coulomb`.
    pub conduit: [f64; 4],
    /// Pulley friction of each tendon, between gauge and joint: the largest difference between the tensions on the two
    /// sides, as a fraction of the smaller one. The gauges do not measure this friction.
    pub pulley: [f64; 4],
    /// Coulomb friction of each joint, N cm.
    pub joint_coulomb: [f64; 3],
    /// Viscous friction of each joint, N cm s/rad.
    pub joint_viscous: [f64; 3],
}

impl Default for ConfiguredFriction {
    fn default() -> Self {
        Self {
            motor_coulomb: [0.07; 4],
            conduit: [0.05; 4],
            pulley: [0.0; 4],
            joint_coulomb: [0.05; 3],
            joint_viscous: [0.05; 3],
        }
    }
}
