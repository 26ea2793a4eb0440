//! Measures whether fingers come to rest at both ends of the range of damping ratios that `Hand::send_damping` admits.

use crate::Arguments;
use crate::cases::{Case, Friction, direction, has_room};
use crate::closed_loop::{ClosedLoop, Held, Senses};
use crate::contact::residual;
use crate::motion::{ROOM, STEP};
use crate::parallel::{each, worst};
use crate::truths::Truth;
use crate::truths_table::{cases, wanted};
use nalgebra::{Matrix3, Vector3};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng;
use std::error::Error;
use sun2xp::control::AdmissibleDamping;

/// The stiffnesses, N/cm.
const SPRINGS: [f64; 3] = [1.0, 3.0, 6.0];
/// The tap: a force, N, and its duration, s.
const TAP: (Vector3<f64>, f64) = (Vector3::new(1.0, -0.7, 0.8), 0.02);
/// A finger that moves less than this has come to rest, cm rms.
const AT_REST: f64 = 0.01;

/// Prints a row for each finger, and in it a cell for each stiffness and each of three ratios.
pub fn run(arguments: &Arguments, only: &str) -> Result<(), Box<dyn Error>> {
    let cases = cases(arguments, 6, arguments.seeds)?;
    let names = SPRINGS.map(|spring| format!("{spring} N/cm: least | 1 | most"));
    println!("| finger | {} | faults |\n|{}", names.join(" | "), "---|".repeat(2 + 3 * SPRINGS.len()));
    for truth in wanted(only) {
        println!("{}", row(truth, &cases));
    }
    Ok(())
}

fn row(truth: &Truth, cases: &[Case]) -> String {
    let poses: Vec<_> = cases
        .iter()
        .flat_map(|case| case.poses().into_iter().enumerate().map(move |(number, pose)| (case, number, pose)))
        .collect();
    let found = each(&poses, |_, (case, number, pose)| at_pose(case, *number, pose, truth));
    let cells = (0..3 * SPRINGS.len()).map(|cell| {
        let motions = || found.iter().map(|(motions, _)| motions[cell]);
        let restless = motions().filter(|motion| motion.is_nan() || *motion > AT_REST).count();
        format!("{:.0} ({restless})", 1e4 * worst(motions()))
    });
    let faults: Vec<_> = found.iter().filter_map(|(_, fault)| fault.as_ref()).collect();
    let fault = faults.first().map_or(String::new(), |fault| format!(": {fault}"));
    format!("| {} | {} | {}{fault} |", truth.name, cells.collect::<Vec<_>>().join(" | "), faults.len())
}

/// Returns the motion that remains 1 s after the tap for each stiffness and ratio, cm rms, and the first fault.
fn at_pose(case: &Case, number: usize, pose: &Vector3<f64>, truth: &Truth) -> (Vec<f64>, Option<String>) {
    let belief = case.finger(pose, Friction::Default);
    let mut finger = belief.clone();
    (truth.differ)(&mut finger);
    let mut random = Pcg64::seed_from_u64(case.seed + 100 + number as u64);
    let mut directions = (0..20).map(|_| direction(&mut random));
    let way = directions.find(|way| has_room(&finger, pose, way, ROOM)).unwrap_or_default();
    let (mut motions, mut fault) = (Vec::new(), None);
    for spring in SPRINGS {
        let (least, most) = AdmissibleDamping::new(&belief, case.rate).range(spring);
        let kx = Matrix3::identity() * spring;
        let held =
            ClosedLoop::new(&Held { case, finger: &finger, belief: &belief, pose, kx: &kx, senses: Senses::Counts });
        for damping in [least, 1.0, most] {
            let mut run = held.clone();
            run.set_point.damping = damping;
            run.run(0.3);
            let target = run.anchor() + way * STEP;
            assert!(run.move_anchor(&target), "a direction with room");
            run.run(0.8);
            run.push(TAP.0);
            run.run(TAP.1);
            run.push(Vector3::zeros());
            run.run(1.0);
            motions.push(residual(&run.tips(0.3)));
            let alarm = run.fault.map(|alarm| format!("{alarm:?} at {spring} N/cm, damping {damping:.2}"));
            fault = fault.or(alarm);
        }
    }
    (motions, fault)
}
