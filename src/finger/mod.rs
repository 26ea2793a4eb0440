//! One finger's servo thread and its mailboxes: the shell around the pure core.

mod faults;
mod mailbox;
mod servo;
mod single;
mod watching;

pub use faults::{Description, Fault, FaultKind, Part, Quantity, Severity, Warnings};
pub use mailbox::{Adjustable, FingerReport, Mailbox, Order, Stage};
pub use servo::{ServedPort, Servo};
pub use single::FingerServo;
