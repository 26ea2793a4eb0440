//! The messages between `sun2xp serve` and its clients, as docs/remote-protocol.md specifies them. This package does no
//! I/O. `decode` refuses every payload that the page does not allow, and names the field. `encode` refuses a message
//! that `decode` would refuse, so no such message leaves a program.

#![forbid(unsafe_code)]
#![warn(missing_docs)]

mod action;
mod answer;
mod bytes;
mod code;
mod error;
mod event;
mod fault_text;
mod finger;
mod finger_status;
mod keys;
mod kind;
mod name;
mod part;
mod path;
mod record;
mod request;
mod stage;
mod state;
mod status;
mod target;

pub use action::Action;
pub use answer::Answer;
pub use code::Code;
pub use error::{DecodeError, FieldError, Reason};
pub use event::Event;
pub use fault_text::FaultText;
pub use finger::{FINGERS, Finger};
pub use finger_status::FingerStatus;
pub use keys::{EVERY_STATUS, HandKeys, hand_of_status};
pub use kind::MessageKind;
pub use name::{ClientName, HandName, NameError};
pub use part::{Part, Place};
pub use path::{MOST_POSES, PathPose};
pub use record::Record;
pub use request::Request;
pub use stage::Stage;
pub use state::{MOST_RECORDS, State};
pub use status::{Counts, Status};
pub use target::{LONGEST_VALIDITY_MS, MOST_PARTS, Target};

/// The version of the protocol.
pub const VERSION: u8 = 1;
