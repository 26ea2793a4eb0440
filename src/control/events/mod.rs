//! Detectors derive observations from the measurements, the report and the set point of a cycle: facts that a planner
//! or a reflex may wait for, and that are no faults. Each detector has one file, which defines its observations.
//!
//! The detectors run while a finger follows a set point.

mod observation;

pub use observation::{Observation, ObservationKind, Observations};
