//! Detects that a contact is about to slip: the force at the fingertip leaves the cone of `events.slip_friction`, which
//! should be narrower than the friction cone.
//!
//! Without touch sensors, the normal of a contact is not measured. The detector uses the direction that the force has
//! when the finger first comes to rest during the contact. This direction is the normal if the finger has pressed
//! against the object and has not carried it yet. The motion of the tip shows a slip only at more than about 0.5 cm/s,
//! because lower speeds are within the noise of the joint rates. By then the object is lost. The force, in contrast,
//! leaves the cone before the contact slides.

use super::observation::{ObservationKind, Observations};
use crate::control::contact::ContactEstimate;
use crate::model::configuration::ConfiguredEvents;
use crate::model::{Part, direction};
use nalgebra::Vector3;

/// Shortest time between two reported slips of the same contact, s. If a reflex makes the finger press harder at the
/// first slip, the finger reaches its new force in this time.
const PAUSE: f64 = 0.05;

/// Detects slip.
#[derive(Clone, Debug)]
pub(super) struct SlipDetector {
    /// Largest ratio of the force along the surface to the force normal to it. `None` switches the detector off.
    friction: Option<f64>,
    /// Number of cycles for which a contact must exist before its normal is taken.
    settling: u32,
    /// Smallest number of cycles between two reported slips.
    pause: u32,
}

/// What the detector remembers of the present contact.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SlipState {
    /// Number of cycles since the contact was made.
    cycles: u32,
    /// Direction of the force of the surroundings on the tip at the first rest, in the finger's frame.
    normal: Option<Vector3<f64>>,
    /// Number of cycles for which no further slip is reported.
    pause: u32,
}

impl SlipDetector {
    pub fn new(events: &ConfiguredEvents, rate: f64) -> Self {
        Self {
            friction: events.slip_friction,
            settling: (events.settled_ms * 1e-3 * rate).ceil() as u32,
            pause: (PAUSE * rate).ceil() as u32,
        }
    }

    /// Runs one cycle. `settled` is true if the joints have come to rest since the set point changed.
    pub fn observe(
        &self,
        state: &mut SlipState,
        contact: &ContactEstimate,
        settled: bool,
        observations: &mut Observations,
    ) {
        let Some(friction) = self.friction.filter(|_| contact.touching) else {
            *state = SlipState::default();
            return;
        };
        (state.cycles, state.pause) = (state.cycles.saturating_add(1), state.pause.saturating_sub(1));
        let force = contact.force;
        let Some(normal) = state.normal else {
            if settled && state.cycles >= self.settling {
                state.normal = direction(&force);
            }
            return;
        };
        let across = force.dot(&normal);
        let along = (force - normal * across).norm();
        if along > friction * across && state.pause == 0 {
            state.pause = self.pause;
            let [x, y, z]: [f64; 3] = contact.force_on_surroundings().into();
            observations.add(ObservationKind::Slip, Part::Finger, [x, y, z, 0.0]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the number of slips in `cycles` cycles with this force of the surroundings on the tip. Checks that each
    /// slip is reported with the opposite force, which is the force of the tip on its surroundings.
    fn slips(state: &mut SlipState, force: [f64; 3], settled: bool, cycles: usize) -> usize {
        let events = ConfiguredEvents { slip_friction: Some(0.5), ..ConfiguredEvents::default() };
        let detector = SlipDetector::new(&events, 1000.0);
        let contact = ContactEstimate { force: force.into(), touching: force != [0.0; 3], ..Default::default() };
        let mut observations = Observations::default();
        (0..cycles).for_each(|_| detector.observe(state, &contact, settled, &mut observations));
        let [x, y, z] = force.map(|component| -component);
        observations
            .iter()
            .for_each(|slip| assert_eq!((slip.kind, slip.values), (ObservationKind::Slip, [x, y, z, 0.0])));
        observations.iter().count()
    }

    #[test]
    fn a_force_outside_the_cone_around_the_first_force_at_rest_is_a_slip() {
        let mut state = SlipState::default();
        // First the finger moves in contact. Then the finger rests, and presses along y.
        assert_eq!(slips(&mut state, [1.0, 1.0, 0.0], false, 500), 0);
        assert_eq!(slips(&mut state, [0.0, 2.0, 0.0], true, 1), 0);
        // Then a load acts along z.
        assert_eq!(slips(&mut state, [0.0, 2.0, 0.95], true, 500), 0);
        assert_eq!(slips(&mut state, [0.0, 2.0, 1.05], true, 1), 1);
        assert_eq!(slips(&mut state, [0.0, 2.0, 1.05], true, 49), 0);
        assert_eq!(slips(&mut state, [0.0, 2.0, 1.05], true, 100), 2);
        // A larger force along the normal permits a larger force along the surface.
        assert_eq!(slips(&mut state, [0.0, 4.0, 1.9], true, 100), 0);
        // A new contact has a new normal.
        assert_eq!(slips(&mut state, [0.0; 3], true, 1), 0);
        assert_eq!(slips(&mut state, [0.0, 0.0, 1.0], true, 200), 0);
        assert_eq!(slips(&mut state, [0.0, 1.0, 1.0], true, 1), 1);
    }
}
