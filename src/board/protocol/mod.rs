//! The frames of the board protocol. This module has no input or output and no clock, and its codec does not use the
//! heap. The specification is `docs/board-protocol.md`.

mod command;
mod configure;
mod decoder;
mod fields;
mod hello;
mod kind;
mod message;
mod packet;
mod refused;
mod reply;
mod status;
mod stop;
mod tactile;

pub use command::Command;
pub use configure::{Configure, Configured};
pub use decoder::{Decoder, DecoderCounters};
pub use hello::{Capabilities, FirmwareVersion, Hello, Identity};
pub use kind::{Kind, Malformed};
pub use message::{Frame, Message, WireFrame};
pub use packet::{MAX_FRAME, MAX_WIRE, Packet, WIRE_OVERHEAD, check};
pub use refused::{Reason, Refused};
pub use reply::Reply;
pub use status::Status;
pub use stop::{Stop, Stopped};
pub use tactile::{TactileChange, TactileEvent, TactileRequest};

/// The protocol version that this library supports.
pub const VERSION: u8 = 1;

/// The address in a Hello that means any finger. The finger with the lowest address on the board answers this Hello.
pub const ANY_ADDRESS: u8 = 0;

/// The highest finger address.
pub const HIGHEST_ADDRESS: u8 = 15;

/// The longest time between the last byte of a command and the first byte of its reply, us.
pub const TURNAROUND_MICROSECONDS: u32 = 100;
