//! Events: what happens to a finger, stamped with the cycle to which it belongs. The servo writes the events of its
//! finger into a log without waiting. Any number of readers reads the log.

mod event;
mod kind;
mod log;
mod table;
mod words;

pub use event::{Event, Occurrence};
pub use kind::{Description, ValueKind};
pub use log::{CAPACITY, EventLog, EventReader, EventWriter, event_log};
pub use table::EventKind;
