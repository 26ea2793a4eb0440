//! Stability of a finger with its controller: the one-cycle map of controller and plant, the largest stiffness for
//! which the finger is stable, and the admittance of its tip. Tools and measurements use this module. No servo thread
//! runs any of it.

mod admittance;
mod one_cycle_map;
mod parallel;
mod plant_set;
mod recurrence;
mod rest;
mod samples;
mod stiffness_bound;
mod trial;

pub use admittance::Admittance;
pub use one_cycle_map::OneCycleMap;
pub use plant_set::Variant;
pub use recurrence::growth;
pub use rest::{Rest, Wall};
pub use stiffness_bound::{Limit, NearAxis, Search, StiffnessBound};
