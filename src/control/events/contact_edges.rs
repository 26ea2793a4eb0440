//! Detects the beginning and the end of a contact, and forces beyond a bound.

use super::observation::{ObservationKind, Observations};
use crate::control::contact::ContactEstimate;
use crate::model::Part;
use crate::model::configuration::ConfiguredEvents;

/// After the force has exceeded the bound, it must fall to this fraction of the bound before the detector reports
/// another crossing.
const HYSTERESIS: f64 = 0.9;

/// Detects contacts, from the contact estimate of the controller.
#[derive(Clone, Debug)]
pub(super) struct ContactEdges {
    /// Bound of the force at the fingertip, N.
    force_above: Option<f64>,
}

/// The contact of the previous cycle.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ContactBefore {
    touching: bool,
    beyond: bool,
}

impl ContactEdges {
    pub fn new(events: &ConfiguredEvents) -> Self {
        Self { force_above: events.force_above }
    }

    pub fn observe(&self, before: &mut ContactBefore, contact: &ContactEstimate, observations: &mut Observations) {
        let ContactEstimate { force, touching, .. } = *contact;
        let [x, y, z]: [f64; 3] = contact.force_on_surroundings().into();
        if touching != before.touching {
            let kind = if touching { ObservationKind::Contact } else { ObservationKind::ContactLost };
            observations.add(kind, Part::Finger, [x, y, z, 0.0]);
            before.touching = touching;
        }
        let Some(bound) = self.force_above else {
            before.beyond = false;
            return;
        };
        let size = force.norm();
        if size > bound && !before.beyond {
            before.beyond = true;
            observations.add(ObservationKind::ForceBound, Part::Finger, [x, y, z, bound]);
        } else if size <= HYSTERESIS * bound {
            before.beyond = false;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn edges_and_crossings_are_observed_once() {
        let edges = ContactEdges { force_above: Some(2.0) };
        let mut before = ContactBefore::default();
        let mut observed = |force: f64, touching: bool| {
            let force = Vector3::new(0.0, force, 0.0);
            let mut observations = Observations::default();
            edges.observe(&mut before, &ContactEstimate { force, touching, ..Default::default() }, &mut observations);
            observations.iter().map(|observed| (observed.kind, observed.values)).collect::<Vec<_>>()
        };
        assert_eq!(observed(0.05, false), []);
        assert_eq!(observed(0.2, true), [(ObservationKind::Contact, [0.0, -0.2, 0.0, 0.0])]);
        assert_eq!(observed(2.1, true), [(ObservationKind::ForceBound, [0.0, -2.1, 0.0, 2.0])]);
        for force in [1.9, 2.1, 1.85, 2.5] {
            assert_eq!(observed(force, true), []);
        }
        assert_eq!(observed(1.7, true), []);
        assert_eq!(observed(-2.1, true), [(ObservationKind::ForceBound, [0.0, 2.1, 0.0, 2.0])]);
        assert_eq!(observed(0.0, false), [(ObservationKind::ContactLost, [0.0; 4])]);
        assert_eq!(observed(0.0, false), []);
    }
}
