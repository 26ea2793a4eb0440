//! Detects that a finger has arrived at its set point, and that it has settled.

use super::observation::{ObservationKind, Observations};
use crate::control::signals::{Report, SetPoint};
use crate::model::Part;
use crate::model::configuration::ConfiguredEvents;
use nalgebra::Vector3;

/// The progress of a finger toward the set point in force. A set point that was sent in the cycle of the report, or
/// later, is not yet in force.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Arrival {
    /// Whether the joints have reached the angles of the set point.
    pub arrived: bool,
    /// Whether the joints have come to rest since the set point changed, wherever they are.
    pub settled: bool,
}

/// Detects arrival and rest.
#[derive(Clone, Debug)]
pub(super) struct ArrivalDetector {
    /// Largest difference of a joint from the set point at arrival, rad.
    tolerance: f64,
    /// Largest motion of a joint at rest, rad.
    motion: f64,
    /// The joints have settled after they have stayed at rest for this number of cycles with a reply.
    cycles: u32,
}

/// The set point in force, and what has been observed since it changed.
#[derive(Clone, Copy, Debug)]
pub(super) struct ArrivalState {
    set_point: SetPoint,
    arrival: Arrival,
    /// Joint angles that the joints have kept, rad.
    kept: Vector3<f64>,
    /// Number of cycles for which the joints have kept the angles `kept`.
    rest: u32,
}

impl ArrivalState {
    /// Returns the state of a finger that holds this set point.
    pub fn holding(set_point: SetPoint) -> Self {
        let arrival = Arrival { arrived: true, settled: true };
        Self { set_point, arrival, kept: set_point.joints, rest: 0 }
    }

    pub fn arrival(&self) -> Arrival {
        self.arrival
    }
}

impl ArrivalDetector {
    pub fn new(events: &ConfiguredEvents, rate: f64) -> Self {
        Self {
            tolerance: events.arrived_degrees.to_radians(),
            motion: events.settled_degrees.to_radians(),
            cycles: (events.settled_ms * 1e-3 * rate).ceil() as u32,
        }
    }

    pub fn observe(
        &self,
        state: &mut ArrivalState,
        report: &Report,
        set_point: &SetPoint,
        observations: &mut Observations,
    ) {
        let joints = report.joints;
        if state.set_point != *set_point {
            // A set point that moves in every cycle is reached only after it has stopped.
            *state = ArrivalState { set_point: *set_point, arrival: Arrival::default(), kept: joints, rest: 0 };
            return;
        }
        let values = [joints[0], joints[1], joints[2], 0.0];
        if !state.arrival.arrived && (joints - set_point.joints).amax() <= self.tolerance {
            state.arrival.arrived = true;
            observations.add(ObservationKind::Arrived, Part::Finger, values);
        }
        if state.arrival.settled {
            return;
        }
        if (joints - state.kept).amax() <= self.motion {
            state.rest += 1;
        } else {
            (state.kept, state.rest) = (joints, 0);
        }
        if state.rest >= self.cycles {
            state.arrival.settled = true;
            observations.add(ObservationKind::Settled, Part::Finger, values);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Matrix3;

    fn at(angle: f64) -> SetPoint {
        SetPoint::hard_finger(Vector3::repeat(angle), Matrix3::identity())
    }

    /// Moves the joints toward `target` for `cycles` cycles, at 0.01 rad per cycle. Returns the cycle and the kind of
    /// each observation.
    fn moves(state: &mut ArrivalState, joints: &mut f64, target: f64, cycles: usize) -> Vec<(usize, ObservationKind)> {
        let detector = ArrivalDetector::new(&ConfiguredEvents::default(), 1000.0);
        let set_point = at(target);
        let mut observed = Vec::new();
        for cycle in 0..cycles {
            *joints += (target - *joints).clamp(-0.01, 0.01);
            let report = Report { joints: Vector3::repeat(*joints), ..Report::default() };
            let mut observations = Observations::default();
            detector.observe(state, &report, &set_point, &mut observations);
            observed.extend(observations.iter().map(|observation| (cycle, observation.kind)));
        }
        observed
    }

    #[test]
    fn a_move_arrives_once_and_then_settles_once() {
        let (mut state, mut joints) = (ArrivalState::holding(at(0.5)), 0.5);
        assert_eq!(moves(&mut state, &mut joints, 0.5, 500), []);
        assert_eq!(state.arrival(), Arrival { arrived: true, settled: true });
        let observed = moves(&mut state, &mut joints, 1.0, 1);
        assert_eq!((observed, state.arrival()), (vec![], Arrival::default()));
        // The joints need 50 cycles, and are within 2 degrees, 0.035 rad, after 47. The first of these cycles is
        // already over.
        let observed = moves(&mut state, &mut joints, 1.0, 500);
        assert_eq!(observed, [(45, ObservationKind::Arrived), (148, ObservationKind::Settled)]);
        assert_eq!(moves(&mut state, &mut joints, 1.0, 500), []);
    }

    #[test]
    fn a_set_point_that_moves_is_not_reached_before_it_stops() {
        let (mut state, mut joints) = (ArrivalState::holding(at(0.5)), 0.5);
        for step in 0..300 {
            assert_eq!(moves(&mut state, &mut joints, 0.5 + 0.001 * f64::from(step), 1), []);
        }
        let observed = moves(&mut state, &mut joints, 0.5 + 0.299, 200);
        assert_eq!(observed, [(0, ObservationKind::Arrived), (99, ObservationKind::Settled)]);
    }
}
