//! Telemetry: another process of the same user reads what an open hand does, cycle by cycle. docs/telemetry.md
//! describes the format and its guarantees.
//!
//! The thread that collects the servos' records writes messages into a ring in a memory file. A reader gets the file
//! over a socket, and reads the ring without the hand's help. The hand does not wait for a reader. The servos do no
//! work for telemetry.

mod attach_error;
mod batch;
pub(crate) mod block_ring;
mod handshake;
mod marks;
mod memory_file;
mod message;
mod names;
mod process;
mod publisher;
mod reader;
mod readers;
mod sample;
mod socket;
mod view;
mod waiting;

pub use attach_error::AttachError;
pub use message::{Description, Message, Outgoing, Status};
pub use names::hands;
pub use publisher::{Publisher, Serving};
pub use reader::{Ended, Reader, Received};
pub use sample::Sample;
pub use view::View;
