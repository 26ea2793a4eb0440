//! The largest Kx for which a finger is stable wherever it may be.

use super::Rest;
use super::trial::Trial;
use crate::model::configuration::{ConfiguredFinger, Unusable};
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use rand_distr::{Distribution, UnitSphere};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use std::f64::consts::PI;

/// A bound is a multiple of this, N/cm.
const GRID: f64 = 0.1;

/// A stiffness of which some pose would get less than this part is not on offer.
const LEAST_SCALE: f64 = 0.5;

/// Nearer to the axis of joint 0 than this the tip is next to the singular pose in which nothing holds that joint: such
/// poses are counted apart, cm.
const CLEAR_OF_AXIS: f64 = 3.0;

/// How the bound is looked for.
#[derive(Clone, Copy, Debug)]
pub struct Search {
    /// How many poses, each with a Kx and a load of its own.
    pub samples: usize,
    /// Of all that is random.
    pub seed: u64,
}

/// The largest eigenvalue that Kx may have.
#[derive(Clone, Copy, Debug)]
pub struct StiffnessBound {
    /// N/cm.
    pub stiffness: f64,
    /// What keeps it from being larger, and where, rad.
    pub limit: Limit,
    /// The part of the poses that carry less than the bound in some direction, so that the servo scales Kx down.
    pub scaled: f64,
    /// The smallest such scale.
    pub least_scale: f64,
    /// How many samples were tried at the bound, all stable.
    pub samples: usize,
    /// Of the samples with the tip within 3 cm of the axis of joint 0, where the finger is next to singular and which
    /// the bound does not cover: how many there are, how many are unstable at the bound, and how far from the axis such
    /// a tip is at most, cm.
    pub near_axis: (usize, usize, f64),
}

/// What a bound comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// At more this pose is unstable.
    Unstable(Vector3<f64>),
    /// At more this pose would get less than half of it.
    Scaled(Vector3<f64>),
}

impl Search {
    /// The bound of `finger` with its scheme and gains at `rate`, Hz: every sample of poses within the joint limits, of
    /// Kx with random axes and eigenvalues from 1 N/cm to the bound, of loads that deflect the tip by up to 1 mm, and
    /// of the least, the controller's own and the most damping that such a Kx admits, is stable at it. The servo scales
    /// Kx down where the tendons of a pose carry less, and so it does here.
    ///
    /// # Errors
    /// The key that makes no controller, or `controller` where a pose is unstable with next to no stiffness.
    pub fn bound(&self, finger: &ConfiguredFinger, rate: f64) -> Result<StiffnessBound, Unusable> {
        let trial = Trial::new(finger, rate)?;
        let links = finger.links();
        let (clear, near): (Vec<Rest>, Vec<Rest>) =
            self.rests(finger).into_iter().partition(|rest| links.reach(&rest.joints).abs() >= CLEAR_OF_AXIS);
        let carried = trial.carried(&clear);
        let Some(softest) = (0..clear.len()).min_by(|&one, &other| carried[one].total_cmp(&carried[other])) else {
            let reason = "leave no pose with the tip off the axis of joint 0".into();
            return Err(Unusable { key: "joints.minimum_degrees", reason });
        };
        let most = (carried[softest] / LEAST_SCALE / GRID).floor();
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
            scaled: carried.iter().filter(|&&carried| carried < stiffness).count() as f64 / carried.len() as f64,
            least_scale: (carried[softest] / stiffness).min(1.0),
            samples: clear.len(),
            near_axis: (near.len(), unstable.len(), distances.fold(0.0, f64::max)),
        })
    }

    /// Rests anywhere within the joint limits. Where Kx is between softest and stiffest: its eigenvalues are 0 to 1,
    /// the largest is 1 in three of four, one of them isotropic, and anything in the fourth. The relative damping is
    /// none, 1 or without limit in turn, to be clamped to what the stiffness admits.
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

/// The largest bound up to `most` at which every rest is stable, in steps of the grid, and the pose that keeps it from
/// being larger. None where every rest is stable at `most`.
///
/// # Errors
/// `controller` where a rest is unstable with next to no stiffness.
fn lower_until_stable(trial: &Trial, rests: &[Rest], most: f64) -> Result<Option<(f64, Vector3<f64>)>, Unusable> {
    let mut bound = most;
    let mut limit = None;
    loop {
        let unstable = trial.unstable(rests, bound * GRID);
        if unstable.is_empty() {
            return Ok(limit.map(|joints| (bound, joints)));
        }
        for rest in unstable {
            // The bound may be lower by now than the one at which this rest was unstable.
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

/// The largest bound below `unstable` at which a rest is stable, by bisection, in steps of the grid.
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
        "leaves the finger unstable at any stiffness at {:.0?} degrees: leave its gains out, or choose another scheme",
        degrees.as_slice()
    );
    Unusable { key: "controller", reason }
}

/// Any direction, of unit length.
fn direction(random: &mut Pcg64) -> Vector3<f64> {
    Vector3::from(<UnitSphere as Distribution<[f64; 3]>>::sample(&UnitSphere, random))
}

fn uniform(random: &mut Pcg64, low: f64, high: f64) -> f64 {
    low + (high - low) * f64::from(random.next_u32()) / 4294967296.0
}
