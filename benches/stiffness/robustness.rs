//! Measures fingers that differ from the controller's configuration, for rows of the table in docs/stiffness.md.

use crate::cases::{Case, Friction, stiffen};
use crate::closed_loop::{Held, Senses};
use crate::identification;
use crate::parallel::{each, worst};
use crate::statics::{self, Fidelity};
use nalgebra::Matrix3;
use sun2xp::calibration::Obstacle;
use sun2xp::model::configuration::ConfiguredFinger;

/// Measures the apparent stiffness of a finger that differs from the controller's configuration. There is no friction
/// and the sensors are exact, so that only the wrong configuration causes the error.
fn believing_otherwise(case: &Case, stiffness: f64, differ: impl Fn(&mut ConfiguredFinger) + Sync) -> Fidelity {
    believing(case, stiffness, |finger, _| differ(finger))
}

/// Does the same as [`believing_otherwise`], but the configuration may differ from the default too.
fn believing(
    case: &Case,
    stiffness: f64,
    differ: impl Fn(&mut ConfiguredFinger, &mut ConfiguredFinger) + Sync,
) -> Fidelity {
    Fidelity::worst(&each(&case.poses(), |_, pose| {
        let kx = Matrix3::identity() * stiffness;
        let mut belief = case.finger(pose, Friction::None);
        let mut finger = belief.clone();
        differ(&mut finger, &mut belief);
        let (finger, belief) = (&finger, &belief);
        statics::fidelity(&Held { case, finger, belief, pose, kx: &kx, senses: Senses::Exact })
    }))
}

/// Ratios of the motors' true torques to their commands. The deviations from 1, of 20 %, have the same sign for all
/// motors, or different signs.
pub const MOTOR_CONSTANTS: [[f64; 4]; 4] = [[1.2; 4], [0.8; 4], [1.2, 0.8, 1.2, 0.8], [1.2, 0.8, 0.8, 1.2]];

/// Ratios of the tendons' true stiffness to the configured one. The deviations from 1, of 10 %, have the same sign for
/// all tendons, or different signs.
pub const TENDONS: [[f64; 4]; 4] = [[1.1; 4], [0.9; 4], [1.1, 0.9, 1.1, 0.9], [1.1, 0.9, 0.9, 1.1]];

/// Returns the worst result over motors with each of these ratios.
pub fn motor_constants(case: &Case, stiffness: f64, ratios: &[[f64; 4]]) -> Fidelity {
    let with = |ratio: &[f64; 4]| {
        believing_otherwise(case, stiffness, |finger| finger.simulation.motor_constant_ratio = *ratio)
    };
    Fidelity::worst(&ratios.iter().map(with).collect::<Vec<_>>())
}

/// Returns the worst result over tendons with each of these ratios.
pub fn tendon_stiffness(case: &Case, stiffness: f64, ratios: &[[f64; 4]]) -> Fidelity {
    let with = |ratio: &[f64; 4]| believing_otherwise(case, stiffness, |finger| stiffen(finger, ratio));
    Fidelity::worst(&ratios.iter().map(with).collect::<Vec<_>>())
}

/// Measures tendons with each of these ratios after identification. Returns the worst relative error of an identified
/// tendon stiffness, and how well the tip is the commanded spring at each of the tip stiffnesses `stiffnesses`.
pub fn identified_tendons(
    case: &Case,
    stiffnesses: [f64; 2],
    ratios: &[[f64; 4]],
) -> Result<(f64, [Fidelity; 2]), Obstacle> {
    let found = each(ratios, |_, ratio| identification::tendon_stiffness(case, ratio));
    let mut off = 0.0;
    let mut worst_of = [Fidelity { error: 0.0, scale: 1.0 }; 2];
    for (ratio, found) in ratios.iter().zip(found) {
        let found = found?;
        let mut truth = ConfiguredFinger::default();
        stiffen(&mut truth, ratio);
        let truth = truth.simulation.tendon_stiffness;
        off = worst((0..4).map(|tendon| (found[tendon] / truth[tendon] - 1.0).abs()).chain([off]));
        for (so_far, stiffness) in worst_of.iter_mut().zip(stiffnesses) {
            let differ = |finger: &mut ConfiguredFinger, belief: &mut ConfiguredFinger| {
                finger.simulation.tendon_stiffness = truth;
                belief.tendon.stiffness = found;
            };
            *so_far = Fidelity::worst(&[*so_far, believing(case, stiffness, differ)]);
        }
    }
    Ok((off, worst_of))
}
