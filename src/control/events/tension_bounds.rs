//! Detects tensions that cross a configured bound.

use super::observation::{ObservationKind, Observations};
use crate::control::signals::Report;
use crate::model::Part;
use crate::model::configuration::ConfiguredEvents;

/// A tension must return by this fraction of the bound before the detector observes it again. The fraction covers the
/// noise of the gauges and the dither.
const HYSTERESIS: f64 = 0.05;

/// Smallest hysteresis, N.
const LEAST_HYSTERESIS: f64 = 0.2;

/// Detects a tension that rises above the upper bound or falls below the lower one.
#[derive(Clone, Debug)]
pub(super) struct TensionBounds {
    /// Upper bound, N.
    above: Option<f64>,
    /// Lower bound, N.
    below: Option<f64>,
}

impl TensionBounds {
    pub fn new(events: &ConfiguredEvents) -> Self {
        Self { above: events.tension_above, below: events.tension_below }
    }

    /// `beyond` holds whether each tension is beyond a bound.
    pub fn observe(&self, beyond: &mut [bool; 4], report: &Report, observations: &mut Observations) {
        for (tendon, beyond) in beyond.iter_mut().enumerate() {
            let tension = report.tensions[tendon];
            match self.crossed(tension, false) {
                Some(bound) if !*beyond => {
                    *beyond = true;
                    observations.add(ObservationKind::TensionBound, Part::tendon(tendon), [tension, bound, 0.0, 0.0]);
                }
                _ => *beyond = *beyond && self.crossed(tension, true).is_some(),
            }
        }
    }

    /// Returns the bound that the tension has crossed. With `eased`, the bounds are moved inward by the hysteresis.
    fn crossed(&self, tension: f64, eased: bool) -> Option<f64> {
        let ease = |bound: f64| if eased { (HYSTERESIS * bound).max(LEAST_HYSTERESIS) } else { 0.0 };
        let above = self.above.filter(|bound| tension > bound - ease(*bound));
        above.or(self.below.filter(|bound| tension < bound + ease(*bound)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector4;

    #[test]
    fn each_crossing_is_observed_once() {
        let bounds = TensionBounds { above: Some(20.0), below: Some(4.0) };
        let mut beyond = [false; 4];
        let mut observed = |tension: f64| {
            let report = Report { tensions: Vector4::new(10.0, 10.0, tension, 10.0), ..Report::default() };
            let mut observations = Observations::default();
            bounds.observe(&mut beyond, &report, &mut observations);
            observations.iter().map(|observed| (observed.part, observed.values)).collect::<Vec<_>>()
        };
        let crossing = |tension, bound| vec![(Part::Tendon(3), [tension, bound, 0.0, 0.0])];
        assert_eq!(observed(19.9), vec![]);
        assert_eq!(observed(20.1), crossing(20.1, 20.0));
        // The tension stays within the hysteresis of 1 N.
        for tension in [20.5, 19.5, 20.5, 19.1] {
            assert_eq!(observed(tension), vec![]);
        }
        assert_eq!(observed(18.9), vec![]);
        assert_eq!(observed(20.2), crossing(20.2, 20.0));
        assert_eq!(observed(10.0), vec![]);
        assert_eq!(observed(3.9), crossing(3.9, 4.0));
        assert_eq!(observed(4.1), vec![]);
    }

    #[test]
    fn without_bounds_nothing_is_observed() {
        let bounds = TensionBounds::new(&ConfiguredEvents::default());
        let mut observations = Observations::default();
        for tension in [-1e9, 0.0, 1e9] {
            let report = Report { tensions: Vector4::from_element(tension), ..Report::default() };
            bounds.observe(&mut [false; 4], &report, &mut observations);
        }
        assert_eq!(observations.iter().count(), 0);
    }
}
