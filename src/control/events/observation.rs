//! Results of the detectors.

use crate::model::Part;

/// What a detector observes. The values of each observation are given in parentheses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ObservationKind {
    /// The fingertip touches something (force of the tip on its surroundings in the finger's frame, N).
    Contact,
    /// The fingertip no longer touches anything (force of the tip on its surroundings in the finger's frame, N).
    ContactLost,
    /// The contact at the fingertip is about to slip (force of the tip on its surroundings in the finger's frame, N).
    Slip,
    /// The tension of a tendon crosses a configured bound (tension and bound, N).
    TensionBound,
    /// The force at the fingertip exceeds the configured bound (force of the tip on its surroundings in the
    /// finger's frame, and bound, N).
    ForceBound,
    /// A joint reaches its limit (angle and limit, rad).
    JointAtLimit,
    /// The joints have reached the angles of the set point (joint angles, rad).
    Arrived,
    /// The joints have come to rest after a change of the set point (joint angles, rad).
    Settled,
}

/// An observation with its location and values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// What was observed.
    pub kind: ObservationKind,
    /// The part that was observed.
    pub part: Part,
    /// The values, in the units of the kind. Unused values are 0.
    pub values: [f64; 4],
}

/// Capacity of the list of observations. A cycle has at most 13 observations, because every detector makes at most one
/// observation of each kind for each part.
const MOST: usize = 24;

/// The observations of a cycle, in a list of fixed size, because the servo must not allocate.
#[derive(Clone, Copy, Debug)]
pub struct Observations {
    places: [Option<Observation>; MOST],
    count: usize,
}

impl Default for Observations {
    fn default() -> Self {
        Self { places: [None; MOST], count: 0 }
    }
}

impl Observations {
    /// Appends an observation. An observation for which there is no place is dropped.
    pub fn add(&mut self, kind: ObservationKind, part: Part, values: [f64; 4]) {
        debug_assert!(self.count < MOST, "{kind:?} has no place");
        if let Some(place) = self.places.get_mut(self.count) {
            *place = Some(Observation { kind, part, values });
            self.count += 1;
        }
    }

    /// Returns the observations in the order in which they were added.
    pub fn iter(&self) -> impl Iterator<Item = &Observation> {
        self.places[..self.count].iter().flatten()
    }

    /// Returns whether the list contains an observation of this kind.
    pub fn contain(&self, kind: ObservationKind) -> bool {
        self.iter().any(|observation| observation.kind == kind)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn observations_keep_their_order() {
        let mut observations = Observations::default();
        assert_eq!(observations.iter().count(), 0);
        observations.add(ObservationKind::Arrived, Part::Finger, [0.1, 0.2, 0.3, 0.0]);
        observations.add(ObservationKind::JointAtLimit, Part::joint(2), [1.5, 1.5, 0.0, 0.0]);
        let kinds: Vec<_> = observations.iter().map(|observation| observation.kind).collect();
        assert_eq!(kinds, [ObservationKind::Arrived, ObservationKind::JointAtLimit]);
        assert!(observations.contain(ObservationKind::Arrived) && !observations.contain(ObservationKind::Slip));
    }
}
