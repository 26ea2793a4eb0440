//! An event, and the conversion of observations, faults and warnings to events.

use super::EventKind;
use crate::control::events::{Observation, ObservationKind};
use crate::finger::Fault;
use crate::model::{FingerNumber, Part};
use serde::{Deserialize, Serialize};

/// Something that happened to a finger in one cycle of its servo.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Event {
    /// The finger.
    pub finger: FingerNumber,
    /// Number of the cycle to which the event belongs: the value of [`Losses::cycles`](crate::Losses::cycles) after
    /// this cycle. Cycles count from 1, separately for each finger.
    pub cycle: u64,
    /// Beginning of this cycle, ns of the monotonic clock. All events of a cycle have the same time.
    pub time: u64,
    /// Kind of the event.
    pub kind: EventKind,
    /// Part of the finger that the event concerns.
    pub part: Part,
    /// Values, with the meaning and the units of the kind. Unused values are 0.
    pub values: [f64; 4],
}

/// An event without its finger, cycle and time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occurrence {
    /// Kind of the event.
    pub kind: EventKind,
    /// Part of the finger that the event concerns.
    pub part: Part,
    /// Values, with the meaning and the units of the kind. Unused values are 0.
    pub values: [f64; 4],
}

impl Occurrence {
    /// Returns the event for a fault that stops the finger.
    pub fn fault(fault: &Fault) -> Self {
        Self::of(EventKind::Fault, fault)
    }

    /// Returns the event for a warning.
    pub fn warning(warning: &Fault) -> Self {
        Self::of(EventKind::Warning, warning)
    }

    fn of(kind: EventKind, fault: &Fault) -> Self {
        Self { kind, part: fault.part, values: [f64::from(fault.kind.number()), fault.value, 0.0, 0.0] }
    }
}

impl From<&Observation> for Occurrence {
    fn from(observation: &Observation) -> Self {
        let kind = match observation.kind {
            ObservationKind::Contact => EventKind::Contact,
            ObservationKind::ContactLost => EventKind::ContactLost,
            ObservationKind::Slip => EventKind::Slip,
            ObservationKind::TensionBound => EventKind::TensionBound,
            ObservationKind::ForceBound => EventKind::ForceBound,
            ObservationKind::JointAtLimit => EventKind::JointAtLimit,
            ObservationKind::Arrived => EventKind::Arrived,
            ObservationKind::Settled => EventKind::Settled,
        };
        Self { kind, part: observation.part, values: observation.values }
    }
}
