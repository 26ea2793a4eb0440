//! Stability tests of a finger at rest with samples of poses and springs.

use super::{OneCycleMap, Rest};
use crate::control::AdmissibleDamping;
use crate::model::configuration::{ConfiguredFinger, Unusable};
use nalgebra::Matrix3;
use std::num::NonZero;
use std::thread;

/// Smallest eigenvalue of the tested springs, N/cm, unless the bound is smaller. With a softer spring the finger is
/// nearly limp, whatever the bound is.
const SOFTEST: f64 = 1.0;

/// Tolerance for a modulus above 1. A joint without stiffness has an eigenvalue of 1.
const ROUNDING: f64 = 1e-5;

/// A stiffness that no pose supports, N/cm. The servo scales it down to the supported stiffness.
const UNSUPPORTED: f64 = 1e3;

/// A finger with its controller, for tests with many springs.
pub(super) struct Trial {
    map: OneCycleMap,
    admissible: AdmissibleDamping,
}

impl Trial {
    /// # Errors
    /// If no controller can be constructed, returns the key of the value that prevents it, and the reason.
    pub fn new(finger: &ConfiguredFinger, rate: f64) -> Result<Self, Unusable> {
        Ok(Self { map: OneCycleMap::new(finger, rate)?, admissible: AdmissibleDamping::new(finger, rate) })
    }

    /// Returns the isotropic stiffness that each pose supports, N/cm.
    pub fn supported_stiffness(&self, rests: &[Rest]) -> Vec<f64> {
        let isotropic = |rest: &Rest| Rest { stiffness: Matrix3::identity() * UNSUPPORTED, damping: 1.0, ..*rest };
        in_parallel(rests, |rest| UNSUPPORTED * self.map.scale(&isotropic(rest)))
    }

    /// Returns whether a finger at `rest` is stable. The stiffness of `rest` is relative: an eigenvalue of 0 stands for
    /// the softest tested spring, and an eigenvalue of 1 stands for `stiffest`, N/cm.
    pub fn stable(&self, rest: &Rest, stiffest: f64) -> bool {
        let softest = SOFTEST.min(stiffest);
        let stiffness = Matrix3::identity() * softest + rest.stiffness * (stiffest - softest);
        // The samples have relative dampings of 0, 1 and infinity, which are clamped to the admissible range.
        let (least, most) = self.admissible.range(stiffness.symmetric_eigenvalues().max());
        let rest = Rest { stiffness, damping: rest.damping.clamp(least, most), ..*rest };
        self.map.largest_eigenvalue(&rest).is_some_and(|modulus| modulus < 1.0 + ROUNDING)
    }

    /// Returns the samples that are not stable, see [`Trial::stable`].
    pub fn unstable<'a>(&self, rests: &'a [Rest], stiffest: f64) -> Vec<&'a Rest> {
        let stable = in_parallel(rests, |rest| self.stable(rest, stiffest));
        rests.iter().zip(stable).filter(|(_, stable)| !stable).map(|(rest, _)| rest).collect()
    }
}

/// Returns `measure` of every item, in order. It uses as many threads as there are cores.
fn in_parallel<Item: Sync, Found: Send>(items: &[Item], measure: impl Fn(&Item) -> Found + Sync) -> Vec<Found> {
    let threads = thread::available_parallelism().map_or(1, NonZero::get);
    let measure = &measure;
    thread::scope(|scope| {
        let parts: Vec<_> = items
            .chunks(items.len().div_ceil(threads).max(1))
            .map(|part| scope.spawn(move || part.iter().map(measure).collect::<Vec<_>>()))
            .collect();
        parts.into_iter().flat_map(|part| part.join().expect("no measurement panics")).collect()
    })
}
