//! Stability tests of a finger at rest with samples of poses and springs.

use super::parallel::in_parallel;
use super::plant_set::Variant;
use super::samples::Sample;
use super::{OneCycleMap, Rest};
use crate::control::AdmissibleDamping;
use crate::model::Links;
use crate::model::configuration::{ConfiguredFinger, Unusable};

/// Time in which every motion must decay to 1/e, s. At 1000 Hz every eigenvalue of the one-cycle map then has a modulus
/// below about 1 - 1e-4. With state feedback, the slow motions of the default finger usually decay to 1/e in 1.2 s. The
/// slowest motion of all takes 5 s, with the controller of Figure 11 of COINS TR 90-48 and an almost straight finger.
/// So this margin excludes no motion that is merely slow.
const DECAY_TIME: f64 = 10.0;

/// A stiffness that no pose supports, N/cm. The servo scales it down to the supported stiffness.
const UNSUPPORTED: f64 = 1e3;

/// A finger with its controller, for tests with many springs.
pub(super) struct Trial {
    map: OneCycleMap,
    links: Links,
    admissible: AdmissibleDamping,
    /// Largest modulus of an eigenvalue with which a motion decays to 1/e within [`DECAY_TIME`].
    largest: f64,
}

impl Trial {
    /// # Errors
    /// If no controller can be constructed, returns the key of the value that prevents it, and the reason.
    pub fn new(finger: &ConfiguredFinger, rate: f64, variant: &Variant) -> Result<Self, Unusable> {
        Ok(Self {
            map: OneCycleMap::of_variant(finger, rate, variant)?,
            links: finger.links(),
            admissible: AdmissibleDamping::new(finger, rate),
            largest: (-1.0 / (rate * DECAY_TIME)).exp(),
        })
    }

    /// Returns the isotropic stiffness that each pose supports, N/cm.
    pub fn supported_stiffness(&self, samples: &[Sample]) -> Vec<f64> {
        in_parallel(samples, |sample| UNSUPPORTED * self.map.scale(&sample.with_isotropic(UNSUPPORTED)))
    }

    /// Returns the finger at rest in the pose of a sample. The largest eigenvalue of its spring is at most `stiffest`,
    /// N/cm.
    pub fn rest(&self, sample: &Sample, stiffest: f64) -> Rest {
        sample.at(stiffest, &self.links, |stiffness| self.admissible.range(stiffness))
    }

    /// Returns whether a sample comes to rest with a spring up to `stiffest`, N/cm.
    pub fn stable(&self, sample: &Sample, stiffest: f64) -> bool {
        let modulus = self.map.largest_eigenvalue(&self.rest(sample, stiffest));
        modulus.is_some_and(|modulus| modulus < self.largest)
    }

    /// Returns the samples that are not stable, see [`Trial::stable`].
    pub fn unstable<'a>(&self, samples: &[&'a Sample], stiffest: f64) -> Vec<&'a Sample> {
        let stable = in_parallel(samples, |sample| self.stable(sample, stiffest));
        samples.iter().zip(stable).filter(|(_, stable)| !stable).map(|(&sample, _)| sample).collect()
    }
}
