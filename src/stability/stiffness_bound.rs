//! The largest Kx with which a finger is stable in every pose.

use super::Rest;
use super::trial::Trial;
use crate::model::configuration::{ConfiguredFinger, Unusable};
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use rand_distr::{Distribution, UnitSphere};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::f64::consts::PI;

/// Step of the bound, N/cm. Every bound is a multiple of this step.
const GRID: f64 = 0.1;

/// Smallest fraction of the bound that every pose must support.
const LEAST_SCALE: f64 = 0.5;

/// Distance of the tip from the axis of joint 0 below which a pose is counted separately, cm. Such a pose is near the
/// singular pose in which no tip stiffness holds joint 0.
const CLEAR_OF_AXIS: f64 = 3.0;

/// Parameters of the search.
#[derive(Clone, Copy, Debug)]
pub struct Search {
    /// Number of poses. Each has its own Kx and load.
    pub samples: usize,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// The largest eigenvalue that Kx may have, and what limits it.
#[derive(Clone, Copy, Debug)]
pub struct StiffnessBound {
    /// The bound, N/cm.
    pub stiffness: f64,
    /// What prevents a larger bound.
    pub limit: Limit,
    /// Fraction of the poses that support less than the bound in some direction. The servo scales Kx down in these
    /// poses.
    pub scaled: f64,
    /// The smallest factor by which the servo scales Kx down.
    pub least_scale: f64,
    /// Number of samples tried at the bound. All are stable.
    pub samples: usize,
    /// The samples with the tip within 3 cm of the axis of joint 0, where the finger is nearly singular. The bound does
    /// not cover them. The values are their number, the number that is unstable at the bound, and the largest distance
    /// of an unstable tip from the axis, cm.
    pub near_axis: (usize, usize, f64),
}

/// The reason for a bound.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// With a larger bound the finger is unstable in this pose (joint angles, rad).
    Unstable(Vector3<f64>),
    /// With a larger bound this pose (joint angles, rad) supports less than half of it.
    Scaled(Vector3<f64>),
}

impl Search {
    /// Returns the bound of `finger` with its scheme and gains at `rate`, Hz. Every sample is stable at the bound. The
    /// samples are poses within the joint limits, Kx with random axes and eigenvalues from 1 N/cm to the bound, and
    /// loads that deflect the tip by up to 1 mm. Their relative damping is the smallest admissible one, 1, or the
    /// largest admissible one. As in the servo, Kx is scaled down where the tendons of a pose support less.
    ///
    /// # Errors
    /// The error names one of these keys:
    /// - the key of a value with which no controller can be constructed
    /// - `controller` if a pose is unstable with almost no stiffness
    /// - `joints.minimum_degrees` if no sample has its tip far enough from the axis of joint 0
    pub fn bound(&self, finger: &ConfiguredFinger, rate: f64) -> Result<StiffnessBound, Unusable> {
        let trial = Trial::new(finger, rate)?;
        let links = finger.links();
        let (clear, near): (Vec<Rest>, Vec<Rest>) =
            self.rests(finger).into_iter().partition(|rest| links.reach(&rest.joints).abs() >= CLEAR_OF_AXIS);
        let supported = trial.supported_stiffness(&clear);
        let Some(softest) = (0..clear.len()).min_by(|&one, &other| supported[one].total_cmp(&supported[other])) else {
            let reason = format!(
                "leaves, with joints.maximum_degrees, no pose whose tip is {CLEAR_OF_AXIS} cm or more from the axis of \
                 joint 0"
            );
            return Err(Unusable { key: "joints.minimum_degrees", reason });
        };
        let most = (supported[softest] / LEAST_SCALE / GRID).floor();
        let lowered = lower_until_stable(&trial, &clear, most)?;
        let (grid_steps, limit) = match lowered {
            None => (most, Limit::Scaled(clear[softest].joints)),
            Some((bound, joints)) => (bound, Limit::Unstable(joints)),
        };
        let stiffness = grid_steps * GRID;
        let unstable = trial.unstable(&near, stiffness);
        let distances = unstable.iter().map(|rest| links.reach(&rest.joints).abs());
        Ok(StiffnessBound {
            stiffness,
            limit,
            scaled: supported.iter().filter(|&&supported| supported < stiffness).count() as f64
                / supported.len() as f64,
            least_scale: (supported[softest] / stiffness).min(1.0),
            samples: clear.len(),
            near_axis: (near.len(), unstable.len(), distances.fold(0.0, f64::max)),
        })
    }

    /// Returns samples of the finger at rest, anywhere within the joint limits. Their `stiffness` is relative, with
    /// eigenvalues from 0 (softest) to 1 (stiffest). Of four samples, one is isotropic with eigenvalue 1, two have
    /// random eigenvalues of which the largest is 1, and one has three random eigenvalues. The relative damping is 1, 0
    /// and infinite in turn. [`Trial::stable`] clamps it to the admissible range.
    fn rests(&self, finger: &ConfiguredFinger) -> Vec<Rest> {
        let mut random = Pcg64::seed_from_u64(self.seed);
        let (low, high) = finger.joint_limits();
        let links = finger.links();
        (0..self.samples)
            .map(|number| {
                let joints = low.zip_map(&high, |low, high| uniform(&mut random, low, high));
                let axis = Unit::new_normalize(direction(&mut random));
                let turn = Rotation3::from_axis_angle(&axis, uniform(&mut random, 0.0, PI));
                let mut principal = Vector3::from_fn(|_, _| uniform(&mut random, 0.0, 1.0));
                match number % 4 {
                    0 => {}
                    1 => principal = Vector3::repeat(1.0),
                    _ => principal /= principal.max(),
                }
                let way = direction(&mut random);
                let tip_way = (links.jacobian(&joints) * way).norm();
                let size = (uniform(&mut random, 0.01, 0.1) / tip_way).min(0.03);
                let stiffness = turn * Matrix3::from_diagonal(&principal) * turn.inverse();
                let damping = [1.0, 0.0, f64::INFINITY][number % 3];
                Rest { joints, deflection: way * size, stiffness, damping }
            })
            .collect()
    }
}

/// Returns the largest bound up to `most` at which every sample is stable, and the pose that prevents a larger bound.
/// Bounds are in units of [`GRID`]. Returns None if every sample is stable at `most`.
///
/// # Errors
/// The error names the key `controller` if a sample is unstable with almost no stiffness.
fn lower_until_stable(trial: &Trial, rests: &[Rest], most: f64) -> Result<Option<(f64, Vector3<f64>)>, Unusable> {
    let mut bound = most;
    let mut limit = None;
    loop {
        let unstable = trial.unstable(rests, bound * GRID);
        if unstable.is_empty() {
            return Ok(limit.map(|joints| (bound, joints)));
        }
        for rest in unstable {
            // The bound may already be lower than the bound at which this sample was unstable.
            if trial.stable(rest, bound * GRID) {
                continue;
            }
            bound = largest_stable(trial, rest, bound);
            limit = Some(rest.joints);
            if bound == 0.0 {
                return Err(unstable_at_any_stiffness(&rest.joints));
            }
        }
    }
}

/// Returns the largest bound below `unstable` at which a sample is stable, by bisection. Bounds are in units of
/// [`GRID`].
fn largest_stable(trial: &Trial, rest: &Rest, unstable: f64) -> f64 {
    let (mut low, mut high) = (0.0, unstable);
    while high - low > 1.0 {
        let middle = ((low + high) / 2.0).floor();
        if trial.stable(rest, middle * GRID) { low = middle } else { high = middle }
    }
    low
}

fn unstable_at_any_stiffness(joints: &Vector3<f64>) -> Unusable {
    let degrees = joints.map(f64::to_degrees);
    let reason = format!(
        "leaves the finger unstable at any stiffness at {:.0?} degrees: remove the gains from this table, or choose \
         another scheme",
        degrees.as_slice()
    );
    Unusable { key: "controller", reason }
}

/// Returns a random unit vector.
fn direction(random: &mut Pcg64) -> Vector3<f64> {
    Vector3::from(<UnitSphere as Distribution<[f64; 3]>>::sample(&UnitSphere, random))
}

fn uniform(random: &mut Pcg64, low: f64, high: f64) -> f64 {
    low + (high - low) * f64::from(random.next_u32()) / 4294967296.0
}
