//! Stability of a finger with its controller: the one-cycle map of core and plant, and the largest stiffness for which
//! the finger is stable. Tools and measurements use this module. No servo thread runs any of it.

mod one_cycle_map;
mod recurrence;
mod stiffness_bound;
mod trial;

pub use one_cycle_map::{OneCycleMap, Rest};
pub use recurrence::growth;
pub use stiffness_bound::{Limit, Search, StiffnessBound};
