//! Named faults: everything that can go wrong with a finger, with numbers that never change and texts for the person at
//! the bench.

mod at_link;
mod description;
mod fault;
mod from_monitors;
mod kind;
mod table;
mod warnings;

pub use description::{Description, PartKind, Quantity, Severity};
pub use fault::Fault;
pub use table::FaultKind;
pub use warnings::Warnings;
