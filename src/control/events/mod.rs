//! Detectors derive observations from the measurements, the report and the set point of a cycle. An observation is a
//! fact that a planner or a reflex may wait for. It is not a fault. Each detector has one file, which defines when it
//! makes its observations.
//!
//! The detectors run while a finger follows a set point, in the cycles with a reply.

mod arrival;
mod contact_edges;
mod detectors;
mod joint_limits;
mod observation;
mod slip;
mod tension_bounds;

pub use arrival::Arrival;
pub use detectors::{DetectorState, Detectors};
pub use observation::{Observation, ObservationKind, Observations};
