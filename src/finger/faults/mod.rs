//! Named faults: what can go wrong with a finger. Each kind of fault has a number, which never changes, and a text for
//! the user.

mod action;
mod at_link;
mod description;
mod fault;
mod from_monitors;
mod kind;
mod table;
mod table_macro;
mod warnings;

pub use action::Action;
pub use description::{Description, PartKind, Quantity, Severity};
pub use fault::Fault;
pub use table::FaultKind;
pub(super) use warnings::RecentWarnings;
pub use warnings::Warnings;
