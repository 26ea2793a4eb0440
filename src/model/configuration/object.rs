//! `[hand.simulated_object]`: an object that all fingers of the simulated hand can touch.

use serde::{Deserialize, Serialize};

/// The shape of an object. Its density is uniform, so its centre of mass is at its geometric centre.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum ObjectShape {
    /// A ball.
    Ball {
        /// Radius, cm.
        radius: f64,
    },
    /// A box. At the start, its edges are parallel to the axes of the palm's frame.
    Box {
        /// Lengths of the edges along x, y and z, cm.
        size: [f64; 3],
    },
}

/// `[hand.simulated_object]`: a free rigid body with gravity and Coulomb friction. All simulated fingers of the hand
/// touch the same object.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(default, deny_unknown_fields)]
pub struct ConfiguredObject {
    /// Shape and size.
    pub shape: ObjectShape,
    /// Mass, kg.
    pub mass: f64,
    /// Coefficient of friction at the fingertips and on the table.
    pub friction: f64,
    /// Stiffness of a contact, normal to the surface and along it, N/cm.
    pub stiffness: f64,
    /// Position of the centre at the start, in the palm's frame, cm.
    pub position: [f64; 3],
    /// Distance of a table from the palm's origin, cm, measured along gravity, or along the palm's z axis if the hand
    /// has no gravity. Without this key there is no table.
    pub table: Option<f64>,
}

impl Default for ConfiguredObject {
    fn default() -> Self {
        Self {
            shape: ObjectShape::Ball { radius: 2.0 },
            mass: 0.1,
            friction: 0.6,
            stiffness: 50.0,
            position: [0.0, 0.0, 10.0],
            table: None,
        }
    }
}
