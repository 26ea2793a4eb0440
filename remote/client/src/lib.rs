//! A hand that `sun2xp serve` offers on another machine. A planner opens a [`RemoteHand`] and calls it as it calls the
//! `Hand` of the package `sun2xp`. Lengths are in cm, forces in N, angles in rad and stiffnesses in N/cm.
//!
//! Calls that send set points check their arguments, put them into a mailbox and return. A thread sends the newest set
//! points to the hand, and repeats them. If the hand no longer receives them, it holds its pose softly, and later goes
//! to its end state (docs/remote-protocol.md). A client that has lost the hand does not acquire it again by itself.

#![deny(unsafe_code)]
#![warn(missing_docs)]

mod admission;
mod change;
mod clock;
mod command;
mod configuration;
mod connection;
mod discovery;
mod error;
mod events;
mod exchange;
mod hand;
mod link;
mod outbox;
mod progress;
mod server_clock;
mod slot;
mod spring;
mod together;
mod view;

pub use admission::AdmissionError;
pub use command::{FingerCommand, Pose};
pub use configuration::{RemoteConfiguration, RemoteTls};
pub use discovery::{Discovered, discover};
pub use error::{Loss, RemoteError, RemoteErrorKind};
pub use events::RemoteEvents;
pub use hand::{RemoteFingerTip, RemoteHand};
pub use progress::RemoteProgress;
pub use sun2xp_remote_protocol::{
    ClientName, Counts, Event, FINGERS, FaultText, Finger, FingerStatus, HandName, PathPose, Record, Stage, Status,
};
pub use together::send_together;
pub use view::RemoteStatistics;
