//! The largest Kx with which a finger is stable in the sampled poses.

use super::Rest;
use super::plant_set::Variant;
use super::samples::{SOFTEST, Sample, samples};
use super::trial::Trial;
use crate::model::configuration::{ConfiguredFinger, Unusable};
use nalgebra::Vector3;

/// Step of the bound, N/cm. Every bound is a multiple of this step.
const GRID: f64 = 0.1;

/// Every pose must support at least this fraction of the bound.
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
    /// Whether every finger presses against a wall.
    pub walls: bool,
}

/// The largest eigenvalue that Kx may have, and what limits it.
#[derive(Clone, Debug)]
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
    /// Number of samples tried at the bound. All but those in `uncovered` are stable.
    pub samples: usize,
    /// The samples that are unstable even at 1 N/cm. Lowering the bound that far does not make them stable, so they do
    /// not limit it.
    pub uncovered: Vec<Rest>,
}

/// The samples with the tip within 3 cm of the axis of joint 0, where the finger is nearly singular. The bound does not
/// cover them.
#[derive(Clone, Copy, Debug)]
pub struct NearAxis {
    /// Number of samples.
    pub samples: usize,
    /// Number of samples that are unstable at the bound.
    pub unstable: usize,
    /// The largest distance of an unstable tip from the axis, cm.
    pub distance: f64,
}

/// The reason for a bound.
#[derive(Clone, Debug)]
pub enum Limit {
    /// With a larger bound the finger is unstable in this sample. The stiffness given here is that of the sample at the
    /// next larger bound.
    Unstable(Box<Rest>),
    /// With a larger bound this pose (joint angles, rad) supports less than half of that bound.
    Scaled(Vector3<f64>),
}

impl Search {
    /// Returns the bound of `finger` with its scheme and gains at `rate`, Hz, for a plant that differs from the
    /// controller's model as `variant` says. A sample is stable if every motion decays to 1/e within 10 s. Every sample
    /// is stable at the bound, except those that are unstable with the softest spring too.
    ///
    /// The samples are poses within the joint limits, with the contact types "hard finger" and "soft finger",
    /// stiffnesses with random axes and eigenvalues from 1 N/cm to the bound, either [`Law`](crate::control::Law) of
    /// the spring, and loads that deflect the tip by up to 2 mm. If walls of 30 to 1000 N/cm supply the loads, the
    /// contact can also be a frictionless point. The relative damping is 1, or the smallest or the largest admissible
    /// one. As in the servo, Kx is scaled down in poses in which the tendons support less.
    ///
    /// # Errors
    /// The error names one of these keys:
    /// - the key of a value with which no controller can be constructed
    /// - `joints.minimum_degrees` if no sample has its tip far enough from the axis of joint 0
    pub fn bound(&self, finger: &ConfiguredFinger, rate: f64, variant: &Variant) -> Result<StiffnessBound, Unusable> {
        let trial = Trial::new(finger, rate, variant)?;
        let (clear, _) = self.samples(finger);
        // The servo scales Kx by the tendons of its configuration, not by those of the plant.
        let supported = Trial::new(finger, rate, &Variant::NOMINAL)?.supported_stiffness(&clear);
        let Some(softest) = (0..clear.len()).min_by(|&one, &other| supported[one].total_cmp(&supported[other])) else {
            let reason = format!(
                "together with joints.maximum_degrees, this key leaves no pose whose tip is {CLEAR_OF_AXIS} cm or more \
                 from the axis of joint 0: widen the joint limits"
            );
            return Err(Unusable { key: "joints.minimum_degrees", reason });
        };
        let most = (supported[softest] / LEAST_SCALE / GRID).floor();
        let Lowered { bound, limit, uncovered } = lower_until_stable(&trial, &clear, most);
        let stiffness = bound * GRID;
        let scaled = supported.iter().filter(|&&supported| supported < stiffness).count();
        Ok(StiffnessBound {
            stiffness,
            limit: limit.map_or(Limit::Scaled(clear[softest].joints()), |rest| Limit::Unstable(Box::new(rest))),
            scaled: scaled as f64 / supported.len() as f64,
            least_scale: (supported[softest] / stiffness).min(1.0),
            samples: clear.len(),
            uncovered,
        })
    }

    /// Returns the stability of a finger near the axis of joint 0 with Kx up to `stiffness`, N/cm.
    ///
    /// # Errors
    /// If no controller can be constructed, returns the key of the value that prevents it, and the reason.
    pub fn near_axis(
        &self,
        finger: &ConfiguredFinger,
        rate: f64,
        variant: &Variant,
        stiffness: f64,
    ) -> Result<NearAxis, Unusable> {
        let trial = Trial::new(finger, rate, variant)?;
        let links = finger.links();
        let (_, near) = self.samples(finger);
        let unstable = trial.unstable(&near.iter().collect::<Vec<_>>(), stiffness);
        let distances = unstable.iter().map(|sample| links.reach(&sample.joints()).abs());
        Ok(NearAxis { samples: near.len(), unstable: unstable.len(), distance: distances.fold(0.0, f64::max) })
    }

    /// Returns the samples clear of the axis of joint 0, and those near it.
    fn samples(&self, finger: &ConfiguredFinger) -> (Vec<Sample>, Vec<Sample>) {
        let links = finger.links();
        let clear = |sample: &Sample| links.reach(&sample.joints()).abs() >= CLEAR_OF_AXIS;
        samples(finger, self.samples, self.seed, self.walls).into_iter().partition(clear)
    }
}

/// The result of [`lower_until_stable`].
struct Lowered {
    /// The bound, in units of [`GRID`].
    bound: f64,
    /// A sample that prevents a larger bound, if there is one.
    limit: Option<Rest>,
    /// The samples that are unstable at the smallest bound too.
    uncovered: Vec<Rest>,
}

/// Returns a bound up to `most` at which the covered samples are stable. The covered samples are all samples except
/// those that are unstable at a tried bound and also at the smallest bound. If every sample that is stable at a bound
/// is also stable at all lower bounds, the result is the largest bound at which the covered samples are stable.
fn lower_until_stable(trial: &Trial, samples: &[Sample], most: f64) -> Lowered {
    let least = (SOFTEST / GRID).min(most);
    let mut covered: Vec<&Sample> = samples.iter().collect();
    let mut lowered = Lowered { bound: most, limit: None, uncovered: Vec::new() };
    loop {
        // A sample may be stable at one bound and unstable at a lower one, so all samples are tried again.
        let mut unstable = trial.unstable(&covered, lowered.bound * GRID);
        let hopeless = trial.unstable(&unstable, least * GRID);
        lowered.uncovered.extend(hopeless.iter().map(|sample| trial.rest(sample, least * GRID)));
        let lasting = |sample: &&Sample| !hopeless.iter().any(|hopeless| std::ptr::eq(*hopeless, *sample));
        covered.retain(lasting);
        unstable.retain(lasting);
        if unstable.is_empty() {
            return lowered;
        }
        while let Some(&sample) = unstable.first() {
            lowered.bound = largest_stable(trial, sample, (least, lowered.bound));
            lowered.limit = Some(trial.rest(sample, (lowered.bound + 1.0) * GRID));
            unstable = trial.unstable(&unstable[1..], lowered.bound * GRID);
        }
    }
}

/// Returns the largest bound at which a sample is stable, by bisection between a bound at which it is stable and one at
/// which it is unstable. Bounds are in units of [`GRID`].
fn largest_stable(trial: &Trial, sample: &Sample, (stable, unstable): (f64, f64)) -> f64 {
    let (mut low, mut high) = (stable, unstable);
    while high - low > 1.0 {
        let middle = ((low + high) / 2.0).floor();
        if trial.stable(sample, middle * GRID) { low = middle } else { high = middle }
    }
    low
}
