//! Contact of the fingertip with a fixed surface, elastic and without friction.

use crate::model::configuration::Surface;
use crate::model::direction;
use nalgebra::Vector3;

/// Returns the force on the tip, N, in the finger's frame. `tip` is in cm.
///
/// At a wall without a normal, and at the centre of a ball, the force has no direction. It is zero there.
pub(super) fn force(surface: &Surface, tip: &Vector3<f64>) -> Vector3<f64> {
    let (depth, outward, stiffness) = touch(surface, tip);
    outward * (depth * stiffness)
}

/// Returns the elastic energy, J.
pub(super) fn energy(surface: &Surface, tip: &Vector3<f64>) -> f64 {
    let (depth, _, stiffness) = touch(surface, tip);
    0.5 * stiffness * depth * depth * 0.01
}

/// Returns the depth of the tip below the surface, cm (0 outside), the outward unit normal, and the stiffness, N/cm.
fn touch(surface: &Surface, tip: &Vector3<f64>) -> (f64, Vector3<f64>, f64) {
    let (height, outward, stiffness) = match *surface {
        Surface::Wall { point, normal, stiffness } => {
            let outward = direction_or_zero(&Vector3::from(normal));
            (outward.dot(&(tip - Vector3::from(point))), outward, stiffness)
        }
        Surface::Ball { centre, radius, stiffness } => {
            let from_centre = tip - Vector3::from(centre);
            (from_centre.norm() - radius, direction_or_zero(&from_centre), stiffness)
        }
    };
    ((-height).max(0.0), outward, stiffness)
}

fn direction_or_zero(vector: &Vector3<f64>) -> Vector3<f64> {
    direction(vector).unwrap_or_else(Vector3::zeros)
}
