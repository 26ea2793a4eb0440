//! One finger's servo thread and its mailboxes: the shell around the pure core.

mod fault;
mod mailbox;
mod servo;
mod single;

pub use fault::Fault;
pub use mailbox::{Adjustable, FingerReport, Mailbox, Order, Stage};
pub use servo::{REPLY_WINDOW, ServedPort, Servo};
pub use single::FingerServo;
