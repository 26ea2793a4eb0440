//! Measures the stability rows of the table of measurements (`table.rs`): the eigenvalues of the exact one-cycle map,
//! without friction, with exact measurements, and with all states of the controller.

use crate::cases::{self, Case, Friction, USUAL};
use crate::closed_loop::{ClosedLoop, Held, Senses};
use crate::contact::{INTO, WALLS, wall_off};
use crate::fits;
use crate::parallel::{each, worst};
use nalgebra::{DVector, Matrix3, Vector3};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng;
use sun2xp::model::configuration::ConfiguredFinger;
use sun2xp::model::configuration::Surface;

/// A finger whose stability is measured.
pub struct Sample {
    pub pose: Vector3<f64>,
    pub kx: Matrix3<f64>,
    /// Force on the tip, N.
    pub load: Vector3<f64>,
    pub wall: Option<(Surface, Vector3<f64>)>,
}

/// The results of a row.
pub struct Stability {
    pub samples: usize,
    /// Number of samples that have an eigenvalue outside the unit circle, do not come to rest, or have a slack tendon.
    pub unstable: usize,
    /// Largest modulus of an eigenvalue, per cycle, among the samples that come to rest without a slack tendon.
    pub largest: f64,
}

/// A row of the table that this file measures has this many samples for each pose of the other rows.
const DENSITY: usize = 20;

/// Returns samples in random poses within `limits`. No spring is stiffer than the bound on Kx, and the loads are small.
/// Without a load, tendons 1 and 4 would both be at t_min, where eq. 20 has a kink.
fn samples(case: &Case, limits: &[[f64; 2]; 3]) -> Vec<Sample> {
    let mut random = Pcg64::seed_from_u64(case.seed + 2);
    let bound = case.bound();
    (0..case.poses * DENSITY)
        .map(|number| {
            let pose = cases::pose(&mut random, limits);
            let any = cases::spring(&mut random, 0.5, bound);
            let kx = if number % 4 == 0 { Matrix3::identity() * bound } else { any };
            let deflection = cases::uniform(&mut random, 0.01, 0.1);
            Sample { pose, kx, load: kx * cases::direction(&mut random) * deflection, wall: None }
        })
        .collect()
}

/// Measures fingers in poses within [`USUAL`].
pub fn usual(case: &Case) -> Stability {
    measure(case, &samples(case, &USUAL))
}

/// Measures fingers anywhere within their joint limits, including almost straight ones.
pub fn anywhere(case: &Case) -> Stability {
    let joints = ConfiguredFinger::default().joints;
    let limits = std::array::from_fn(|joint| [joints.minimum_degrees[joint], joints.maximum_degrees[joint]]);
    measure(case, &samples(case, &limits))
}

/// Measures fingers that press against walls in random directions. The stiffnesses of the walls are those in [`WALLS`].
pub fn against_walls(case: &Case) -> Stability {
    let links = ConfiguredFinger::default().links();
    let mut samples = samples(case, &USUAL);
    let mut random = Pcg64::seed_from_u64(case.seed + 3);
    for (number, sample) in samples.iter_mut().enumerate() {
        let (outward, tip) = (cases::direction(&mut random), links.tip(&sample.pose));
        let surface = wall_off(&tip, &outward, WALLS[number % WALLS.len()]);
        sample.wall = Some((surface, tip - outward * INTO));
        sample.load = Vector3::zeros();
    }
    measure(case, &samples)
}

fn measure(case: &Case, samples: &[Sample]) -> Stability {
    let found = each(samples, |_, sample| growth(case, &case.finger(&sample.pose, Friction::None), sample));
    // The fitted eigenvalues have rounding errors.
    const ROUNDING: f64 = 1e-5;
    let inside = |growth: &f64| *growth < 1.0 + ROUNDING;
    Stability {
        samples: found.len(),
        unstable: found.len() - found.iter().flatten().filter(|growth| inside(growth)).count(),
        largest: worst(found.iter().flatten().copied()),
    }
}

/// Returns the largest modulus of an eigenvalue of the one-cycle map, or `None` if the finger does not come to rest or
/// has a slack tendon.
///
/// Runs two fingers, one of which is displaced slightly. Their difference evolves by the linear map alone.
pub fn growth(case: &Case, description: &ConfiguredFinger, sample: &Sample) -> Option<f64> {
    const SETTLED: f64 = 2.0;
    const AT_REST: f64 = 1e-2;
    const WATCHED: f64 = 1.5;
    /// Time between two recorded differences, s. It is long enough to separate the eigenvalues that remain after the
    /// fast modes have decayed.
    const STRIDE: f64 = 0.005;
    let Sample { pose, kx, .. } = sample;
    let held = Held { case, finger: description, belief: description, pose, kx, senses: Senses::Exact };
    let mut finger = ClosedLoop::new(&held);
    finger.push(sample.load);
    if let Some((surface, anchor)) = &sample.wall {
        finger.plant.set_surface(Some(*surface));
        // If the anchor is out of reach, a force of 1 N presses the tip against the wall instead. That sample is
        // equally good.
        if !finger.move_anchor(anchor) {
            finger.push((anchor - finger.anchor()).normalize());
        }
    }
    finger.run(SETTLED);
    finger.reset_extremes();

    let mut displaced = finger.clone();
    for (motor, angle) in [3e-4, -2e-4, 1e-4, 4e-4].into_iter().enumerate() {
        displaced.plant.turn_motor(motor, angle);
    }
    let stride = finger.cycles(STRIDE).max(1);
    let mut speeds = Vec::new();
    let differences: Vec<DVector<f64>> = (0..finger.cycles(WATCHED) / stride)
        .map(|_| {
            for _ in 0..stride {
                finger.cycle();
                displaced.cycle();
            }
            let (a, b) = (&finger.plant, &displaced.plant);
            speeds.push(a.joint_rates().amax());
            // Scales the three kinds of differences to similar size: a motor turns about 20 times as far as a joint,
            // and the rate of a mode at 30 rad/s is 30 times its angle.
            let joints = (a.joints() - b.joints()) * 20.0;
            let rates = (a.joint_rates() - b.joint_rates()) * 0.7;
            let motors = a.motor_angles() - b.motor_angles();
            DVector::from_iterator(10, joints.iter().chain(&rates).chain(&motors).copied())
        })
        .collect();
    let fastest = |part: &[f64]| worst(part.iter().copied());
    let (early, late) = (fastest(&speeds[..speeds.len() / 2]), fastest(&speeds[speeds.len() / 2..]));
    let comes_to_rest = late < AT_REST || late < 0.9 * early;
    (comes_to_rest && finger.least_true > 0.0).then(|| fits::growth(&differences).powf(1.0 / stride as f64))
}
