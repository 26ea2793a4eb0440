//! Waits until fingers of an open hand have arrived at their targets and stay there.

use std::time::{Duration, Instant};
use sun2xp::hand::Hand;

/// When fingers count as arrived.
pub struct Settling {
    /// Largest distance of a joint from its target, rad.
    pub tolerance: f64,
    /// Time within the tolerance. A finger that merely passes its target has not arrived.
    pub rest: Duration,
    /// Time after which the wait fails.
    pub patience: Duration,
}

impl Settling {
    /// Waits until all these fingers rest at their targets at the same time, and returns their positions.
    pub fn wait(&self, hand: &Hand, targets: &[(i32, [f64; 3])]) -> Result<Vec<[f64; 3]>, String> {
        let begun = Instant::now();
        let mut since = begun;
        loop {
            let positions = targets.iter().map(|&(finger, _)| hand.position(finger));
            let positions = positions.collect::<Result<Vec<_>, _>>().map_err(|error| error.to_string())?;
            let distances = positions.iter().zip(targets).map(|(&position, &(_, target))| distance(position, target));
            if distances.fold(0.0, f64::max) > self.tolerance {
                since = Instant::now();
            } else if since.elapsed() > self.rest {
                return Ok(positions);
            }
            if begun.elapsed() > self.patience {
                return Err(format!(
                    "after {:?} the joints are at {positions:?} instead of {targets:?}",
                    self.patience
                ));
            }
            std::thread::sleep(Duration::from_millis(2));
        }
    }
}

/// The largest distance of a joint from its target, rad. An angle that is NaN is infinitely far away: `f64::max` skips
/// NaN, so without this rule a finger whose angles are all NaN would be at its target.
pub fn distance(position: [f64; 3], target: [f64; 3]) -> f64 {
    let distances = position.iter().zip(target).map(|(is, wanted)| (is - wanted).abs());
    distances.map(|distance| if distance.is_nan() { f64::INFINITY } else { distance }).fold(0.0, f64::max)
}
