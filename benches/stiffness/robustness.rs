//! Measures fingers that differ from the controller's configuration, for the rows of `table.rs` on motor constants and
//! tendon stiffness.

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
fn fidelity_of_changed_finger(case: &Case, stiffness: f64, change: impl Fn(&mut ConfiguredFinger) + Sync) -> Fidelity {
    fidelity_after_changes(case, stiffness, |finger, _| change(finger))
}

/// Does the same as [`fidelity_of_changed_finger`], but `change` may change the controller's configuration, its second
/// argument, too.
fn fidelity_after_changes(
    case: &Case,
    stiffness: f64,
    change: impl Fn(&mut ConfiguredFinger, &mut ConfiguredFinger) + Sync,
) -> Fidelity {
    Fidelity::worst(&each(&case.poses(), |_, pose| {
        let kx = Matrix3::identity() * stiffness;
        let mut belief = case.finger(pose, Friction::None);
        let mut finger = belief.clone();
        change(&mut finger, &mut belief);
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

/// Returns the worst result over the entries of `ratios`. Each entry has the ratios of the four motors of one finger.
pub fn motor_constants(case: &Case, stiffness: f64, ratios: &[[f64; 4]]) -> Fidelity {
    let with = |ratio: &[f64; 4]| {
        fidelity_of_changed_finger(case, stiffness, |finger| finger.simulation.motor_constant_ratio = *ratio)
    };
    Fidelity::worst(&ratios.iter().map(with).collect::<Vec<_>>())
}

/// Returns the worst result over the entries of `ratios`. Each entry has the ratios of the four tendons of one finger.
pub fn tendon_stiffness(case: &Case, stiffness: f64, ratios: &[[f64; 4]]) -> Fidelity {
    let with = |ratio: &[f64; 4]| fidelity_of_changed_finger(case, stiffness, |finger| stiffen(finger, ratio));
    Fidelity::worst(&ratios.iter().map(with).collect::<Vec<_>>())
}

/// Identifies the tendons of one finger for each entry of `ratios`, and then measures the finger. Each entry has the
/// ratios of the four tendons. Returns the worst relative error of an identified tendon stiffness, and the worst
/// [`Fidelity`] for each of the tip stiffnesses `stiffnesses`.
pub fn identified_tendons(
    case: &Case,
    stiffnesses: [f64; 2],
    ratios: &[[f64; 4]],
) -> Result<(f64, [Fidelity; 2]), Obstacle> {
    let found = each(ratios, |_, ratio| identification::tendon_stiffness(case, ratio));
    let mut worst_error = 0.0;
    let mut worst_of = [Fidelity { error: 0.0, scale: 1.0 }; 2];
    for (ratio, found) in ratios.iter().zip(found) {
        let found = found?;
        let mut truth = ConfiguredFinger::default();
        stiffen(&mut truth, ratio);
        let truth = truth.simulation.tendon_stiffness;
        let errors = (0..4).map(|tendon| (found[tendon] / truth[tendon] - 1.0).abs());
        worst_error = worst(errors.chain([worst_error]));
        for (so_far, stiffness) in worst_of.iter_mut().zip(stiffnesses) {
            let change = |finger: &mut ConfiguredFinger, belief: &mut ConfiguredFinger| {
                finger.simulation.tendon_stiffness = truth;
                belief.tendon.stiffness = found;
            };
            *so_far = Fidelity::worst(&[*so_far, fidelity_after_changes(case, stiffness, change)]);
        }
    }
    Ok((worst_error, worst_of))
}
