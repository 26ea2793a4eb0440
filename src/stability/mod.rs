//! Whether a finger under its controller comes to rest: the one-cycle map of the core and the plant together, and the
//! largest stiffness for which it does. For tools and measurements; no servo thread runs any of it.

mod one_cycle_map;
mod recurrence;
mod stiffness_bound;
mod trial;

pub use one_cycle_map::{OneCycleMap, Rest};
pub use recurrence::growth;
pub use stiffness_bound::{Limit, Search, StiffnessBound};
