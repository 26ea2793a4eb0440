//! One finger's servo thread and its mailboxes: the shell around the pure core.

mod faults;
mod losses;
mod mailbox;
mod servo;
mod single;

pub use faults::{Description, Fault, FaultKind, Part, Quantity, Severity, Warnings};
pub use losses::Losses;
pub use mailbox::{Adjustable, FingerReport, Mailbox, Order, Stage};
pub use servo::{REPLY_WINDOW, ServedPort, Servo};
pub use single::FingerServo;
