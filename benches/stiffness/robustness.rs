//! Rows in which the controller believes something that is not so.

use crate::cases::{Case, Friction};
use crate::closed_loop::Senses;
use crate::parallel::{each, worst};
use crate::{fits, statics};
use nalgebra::Matrix3;
use sun2xp::model::configuration::ConfiguredFinger;

/// Error of the apparent stiffness where the true finger is not what the controller believes. No friction, exact sensors: what
/// is left is the belief's fault.
fn believing_otherwise(case: &Case, stiffness: f64, differ: impl Fn(&mut ConfiguredFinger) + Sync) -> f64 {
    worst(each(&case.poses(), |_, pose| {
        let kx = Matrix3::identity() * stiffness;
        let belief = case.finger(pose, Friction::None);
        let mut finger = belief.clone();
        differ(&mut finger);
        let (forces, deflections) = statics::pushed_about(case, &finger, &belief, pose, &kx, Senses::Exact);
        fits::spring_error(&forces, &deflections, &kx)
    }))
}

/// Motors that give more or less than their commands: all alike, and against each other.
pub const MOTOR_CONSTANTS: [[f64; 4]; 4] = [[1.2; 4], [0.8; 4], [1.2, 0.8, 1.2, 0.8], [1.2, 0.8, 0.8, 1.2]];

/// Tendons stiffer or softer than believed, by 10 %, alike and against each other.
pub const TENDONS: [[f64; 4]; 4] = [[1.1; 4], [0.9; 4], [1.1, 0.9, 1.1, 0.9], [1.1, 0.9, 0.9, 1.1]];

/// The same by 2 %: calibrated.
pub const CALIBRATED_TENDONS: [[f64; 4]; 4] =
    [[1.02; 4], [0.98; 4], [1.02, 0.98, 1.02, 0.98], [1.02, 0.98, 0.98, 1.02]];

/// Worst error with motors that are off by each of these.
pub fn motor_constants(case: &Case, stiffness: f64, ratios: &[[f64; 4]]) -> f64 {
    worst(
        ratios.iter().map(|ratio| {
            believing_otherwise(case, stiffness, |finger| finger.simulation.motor_constant_ratio = *ratio)
        }),
    )
}

/// Worst error with tendons that are off by each of these.
pub fn tendon_stiffness(case: &Case, stiffness: f64, ratios: &[[f64; 4]]) -> f64 {
    worst(ratios.iter().map(|ratio| {
        believing_otherwise(case, stiffness, |finger| {
            for (stiffness, ratio) in finger.simulation.tendon_stiffness.iter_mut().zip(ratio) {
                *stiffness *= ratio;
            }
        })
    }))
}
