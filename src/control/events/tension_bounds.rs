//! Detects tensions that cross a configured bound.

use super::observation::{ObservationKind, Observations};
use crate::control::signals::Report;
use crate::model::Part;
use crate::model::configuration::ConfiguredEvents;

/// After a tension has crossed a bound, the detector observes the next crossing of this bound only if the tension has
/// meanwhile moved back inside by this fraction of the bound, or has crossed the other bound. The fraction covers the
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

/// The bound that a tension is beyond. If a tendon tears, its tension can go from above the upper bound to below the
/// lower bound between two samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Side {
    Above,
    Below,
}

impl TensionBounds {
    pub fn new(events: &ConfiguredEvents) -> Self {
        Self { above: events.tension_above, below: events.tension_below }
    }

    /// `beyond` holds the bound that each tension is beyond.
    pub fn observe(&self, beyond: &mut [Option<Side>; 4], report: &Report, observations: &mut Observations) {
        for (tendon, beyond) in beyond.iter_mut().enumerate() {
            let tension = report.tensions[tendon];
            match self.crossed(tension) {
                Some((side, _)) if *beyond == Some(side) => {}
                Some((side, bound)) => {
                    *beyond = Some(side);
                    observations.add(ObservationKind::TensionBound, Part::tendon(tendon), [tension, bound, 0.0, 0.0]);
                }
                None => *beyond = beyond.filter(|&side| self.is_near(tension, side)),
            }
        }
    }

    /// Returns the bound that the tension is beyond.
    fn crossed(&self, tension: f64) -> Option<(Side, f64)> {
        let above = self.above.filter(|&bound| tension > bound).map(|bound| (Side::Above, bound));
        above.or(self.below.filter(|&bound| tension < bound).map(|bound| (Side::Below, bound)))
    }

    /// Moves the bound inward by the hysteresis, and returns whether the tension is beyond the moved bound.
    fn is_near(&self, tension: f64, side: Side) -> bool {
        let hysteresis = |bound: f64| (HYSTERESIS * bound).max(LEAST_HYSTERESIS);
        match side {
            Side::Above => self.above.is_some_and(|bound| tension > bound - hysteresis(bound)),
            Side::Below => self.below.is_some_and(|bound| tension < bound + hysteresis(bound)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector4;

    #[test]
    fn each_crossing_is_observed_once() {
        let bounds = TensionBounds { above: Some(20.0), below: Some(4.0) };
        let mut beyond = [None; 4];
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
        // The tendon is pulled and then tears.
        assert_eq!(observed(25.0), crossing(25.0, 20.0));
        assert_eq!(observed(1.0), crossing(1.0, 4.0));
        assert_eq!(observed(21.0), crossing(21.0, 20.0));
    }

    #[test]
    fn bounds_that_are_near_each_other_are_both_observed() {
        let bounds = TensionBounds { above: Some(5.3), below: Some(5.2) };
        let (mut beyond, mut seen) = ([None; 4], 0);
        for tension in [5.4, 5.1, 5.4, 5.1] {
            let report = Report { tensions: Vector4::repeat(tension), ..Report::default() };
            let mut observations = Observations::default();
            bounds.observe(&mut beyond, &report, &mut observations);
            seen += observations.iter().count();
        }
        assert_eq!(seen, 16);
    }

    #[test]
    fn without_bounds_nothing_is_observed() {
        let bounds = TensionBounds::new(&ConfiguredEvents::default());
        let mut observations = Observations::default();
        for tension in [-1e9, 0.0, 1e9] {
            let report = Report { tensions: Vector4::from_element(tension), ..Report::default() };
            bounds.observe(&mut [None; 4], &report, &mut observations);
        }
        assert_eq!(observations.iter().count(), 0);
    }
}
