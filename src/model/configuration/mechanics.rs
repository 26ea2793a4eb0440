//! The controller's model of the masses and the friction of a finger. The true values of the simulated finger are in
//! `[finger.simulation]`. The defaults of the model equal the defaults there. An experiment with a wrong model sets
//! different values in the two places.

use serde::{Deserialize, Serialize};

/// `[finger.links]`: masses and radii. A link is modelled as a uniform cylinder, and the tip as a point mass.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredLinks {
    /// Masses of links 0, 1, 2 and of the tip, kg.
    pub masses: [f64; 4],
    /// Radii of the links, m.
    pub radii: [f64; 3],
}

/// `[finger.friction]`: friction that the controller compensates.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredFriction {
    /// Coulomb friction of each motor, N cm of commanded torque.
    pub motor_coulomb: [f64; 4],
    /// Conduit friction: the fraction of the tension torque that is added to `motor_coulomb`.
    pub conduit: [f64; 4],
    /// Coulomb friction of each joint, N cm.
    pub joint_coulomb: [f64; 3],
    /// Viscous friction of each joint, N cm s/rad.
    pub joint_viscous: [f64; 3],
}

impl Default for ConfiguredLinks {
    fn default() -> Self {
        Self { masses: [0.060, 0.045, 0.025, 0.005], radii: [0.009, 0.008, 0.007] }
    }
}

impl Default for ConfiguredFriction {
    fn default() -> Self {
        Self { motor_coulomb: [0.07; 4], conduit: [0.05; 4], joint_coulomb: [0.05; 3], joint_viscous: [0.05; 3] }
    }
}
