//! Whether a finger is stable at rest, tried with samples of poses and springs.

use super::{OneCycleMap, Rest};
use crate::control::AdmissibleDamping;
use crate::model::configuration::{ConfiguredFinger, Unusable};
use nalgebra::Matrix3;
use std::num::NonZero;
use std::thread;

/// Springs have at least this eigenvalue, N/cm, where the bound is not less: what is softer is nearly limp, whatever
/// the bound.
const SOFTEST: f64 = 1.0;

/// Nothing damps a joint that nothing holds: it has an eigenvalue of 1.
const ROUNDING: f64 = 1e-5;

/// More than any pose carries, N/cm: what is beyond that is scaled away.
const BEYOND: f64 = 1e3;

/// A finger with its controller, to be tried with one spring after the other.
pub(super) struct Trial {
    map: OneCycleMap,
    admissible: AdmissibleDamping,
}

impl Trial {
    /// # Errors
    /// The key that makes no controller.
    pub fn new(finger: &ConfiguredFinger, rate: f64) -> Result<Self, Unusable> {
        Ok(Self { map: OneCycleMap::new(finger, rate)?, admissible: AdmissibleDamping::new(finger, rate) })
    }

    /// The isotropic stiffness that each pose carries, N/cm.
    pub fn carried(&self, rests: &[Rest]) -> Vec<f64> {
        let isotropic = |rest: &Rest| Rest { stiffness: Matrix3::identity() * BEYOND, damping: 1.0, ..*rest };
        in_parallel(rests, |rest| BEYOND * self.map.scale(&isotropic(rest)))
    }

    /// Whether a rest is stable with a Kx between the softest and `stiffest`, N/cm. The stiffness of the rest says
    /// where in between its eigenvalues are, from 0 to 1.
    pub fn stable(&self, rest: &Rest, stiffest: f64) -> bool {
        let softest = SOFTEST.min(stiffest);
        let stiffness = Matrix3::identity() * softest + rest.stiffness * (stiffest - softest);
        // The samples take turns with a damping ratio below, at and above 1, which is clamped to what is admissible.
        let (least, most) = self.admissible.range(stiffness.symmetric_eigenvalues().max());
        let rest = Rest { stiffness, damping: rest.damping.clamp(least, most), ..*rest };
        self.map.largest_eigenvalue(&rest).is_some_and(|modulus| modulus < 1.0 + ROUNDING)
    }

    /// The rests that are not stable; see [`Trial::stable`].
    pub fn unstable<'a>(&self, rests: &'a [Rest], stiffest: f64) -> Vec<&'a Rest> {
        let stable = in_parallel(rests, |rest| self.stable(rest, stiffest));
        rests.iter().zip(stable).filter(|(_, stable)| !stable).map(|(rest, _)| rest).collect()
    }
}

/// `measure` of every item, in order, on as many threads as there are cores.
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
