//! Describes a sample of the search for the bound of Kx, as text and as JSON.

use serde::Serialize;
use sun2xp::control::Law;
use sun2xp::nalgebra::Vector3;
use sun2xp::stability::Rest;

/// A finger at rest.
#[derive(Clone, Debug, Serialize)]
pub struct Sample {
    joints_degrees: [f64; 3],
    contact: &'static str,
    law: &'static str,
    /// Damping relative to the damping that the controller computes from the stiffness.
    damping: f64,
    /// Stiffness of the wall that the tip presses against, N/cm. `None` without a wall.
    wall: Option<f64>,
}

impl Sample {
    pub fn new(rest: &Rest) -> Self {
        Self {
            joints_degrees: degrees(&rest.joints),
            contact: match rest.dimensions() {
                1 => "frictionless point",
                3 => "hard finger",
                _ => "soft finger",
            },
            law: match rest.law {
                Law::Exact => "exact stiffness law",
                _ => "stiffness law of the report",
            },
            damping: rest.damping,
            wall: rest.wall.map(|wall| wall.stiffness),
        }
    }

    pub fn text(&self) -> String {
        let Self { joints_degrees, contact, law, damping, wall } = self;
        let wall = wall.map_or(String::new(), |stiffness| format!(", wall of {stiffness:.0} N/cm"));
        format!("{}, {contact}, {law}, relative damping {damping:.2}{wall}", pose(joints_degrees))
    }
}

/// Returns joint angles in degrees.
pub fn degrees(joints: &Vector3<f64>) -> [f64; 3] {
    joints.map(f64::to_degrees).into()
}

/// Returns joint angles as text.
pub fn pose(degrees: &[f64; 3]) -> String {
    format!("{degrees:.0?} degrees")
}
