//! Rows in which the controller believes something that is not so.

use crate::cases::{Case, Friction};
use crate::closed_loop::Senses;
use crate::parallel::{each, worst};
use crate::{fits, identification, statics};
use nalgebra::Matrix3;
use sun2xp::control::calibration::Obstacle;
use sun2xp::model::configuration::ConfiguredFinger;

/// Error of the apparent stiffness where the true finger is not what the controller believes. No friction, exact sensors: what
/// is left is the belief's fault.
fn believing_otherwise(case: &Case, stiffness: f64, differ: impl Fn(&mut ConfiguredFinger) + Sync) -> f64 {
    believing(case, stiffness, |finger, _| differ(finger))
}

/// The same, where what is true and what is believed both differ from the default.
fn believing(case: &Case, stiffness: f64, differ: impl Fn(&mut ConfiguredFinger, &mut ConfiguredFinger) + Sync) -> f64 {
    worst(each(&case.poses(), |_, pose| {
        let kx = Matrix3::identity() * stiffness;
        let mut belief = case.finger(pose, Friction::None);
        let mut finger = belief.clone();
        differ(&mut finger, &mut belief);
        let (forces, deflections) = statics::pushed_about(case, &finger, &belief, pose, &kx, Senses::Exact);
        fits::spring_error(&forces, &deflections, &kx)
    }))
}

/// Motors that give more or less than their commands: all alike, and against each other.
pub const MOTOR_CONSTANTS: [[f64; 4]; 4] = [[1.2; 4], [0.8; 4], [1.2, 0.8, 1.2, 0.8], [1.2, 0.8, 0.8, 1.2]];

/// Tendons stiffer or softer than believed, by 10 %, alike and against each other.
pub const TENDONS: [[f64; 4]; 4] = [[1.1; 4], [0.9; 4], [1.1, 0.9, 1.1, 0.9], [1.1, 0.9, 0.9, 1.1]];

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
    worst(ratios.iter().map(|ratio| believing_otherwise(case, stiffness, |finger| stiffen(finger, ratio))))
}

/// With tendons that are off by each of these, and a controller that has identified them: the worst error of what it then believes of
/// a tendon, and those of the apparent stiffness at each of `stiffnesses`.
pub fn identified_tendons(
    case: &Case,
    stiffnesses: [f64; 2],
    ratios: &[[f64; 4]],
) -> Result<(f64, [f64; 2]), Obstacle> {
    let found = each(ratios, |_, ratio| identification::tendon_stiffness(case, ratio));
    let mut off = 0.0;
    let mut errors = [0.0; 2];
    for (ratio, found) in ratios.iter().zip(found) {
        let found = found?;
        let mut truth = ConfiguredFinger::default();
        stiffen(&mut truth, ratio);
        let truth = truth.simulation.tendon_stiffness;
        off = worst((0..4).map(|tendon| (found[tendon] / truth[tendon] - 1.0).abs()).chain([off]));
        for (error, stiffness) in errors.iter_mut().zip(stiffnesses) {
            let differ = |finger: &mut ConfiguredFinger, belief: &mut ConfiguredFinger| {
                finger.simulation.tendon_stiffness = truth;
                belief.tendon.stiffness = found;
            };
            *error = worst([*error, believing(case, stiffness, differ)]);
        }
    }
    Ok((off, errors))
}

/// Makes the true tendons so many times as stiff.
pub fn stiffen(finger: &mut ConfiguredFinger, ratio: &[f64; 4]) {
    for (stiffness, ratio) in finger.simulation.tendon_stiffness.iter_mut().zip(ratio) {
        *stiffness *= ratio;
    }
}
