//! `[finger.links]`: the controller's model of the masses of a finger. The true values of the simulated finger are in
//! `[finger.simulation]`. The defaults here equal the defaults there. An experiment with a wrong model sets different
//! values in the two places.

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

impl Default for ConfiguredLinks {
    fn default() -> Self {
        Self { masses: [0.060, 0.045, 0.025, 0.005], radii: [0.009, 0.008, 0.007] }
    }
}
