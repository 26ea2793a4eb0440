//! The board protocol as bytes. No input, no output, no clock, no heap. The page that counts is
//! `docs/board-protocol.md`.

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
mod wire;

pub use command::Command;
pub use configure::{Configure, Configured};
pub use decoder::{Decoder, DecoderCounters};
pub use hello::{Capabilities, FirmwareVersion, Hello, Identity};
pub use kind::{Kind, Malformed};
pub use message::{Frame, Message};
pub use packet::{MAX_FRAME, MAX_WIRE, Packet, WIRE_OVERHEAD, check};
pub use refused::{Reason, Refused};
pub use reply::Reply;
pub use status::Status;
pub use stop::{Stop, Stopped};
pub use tactile::{TactileChange, TactileEvent, TactileRequest};
pub use wire::WireFrame;

/// The protocol version that this library speaks.
pub const VERSION: u8 = 1;

/// In a Hello: whichever finger of the board has the lowest address answers.
pub const ANY_ADDRESS: u8 = 0;

/// The highest address of a finger.
pub const HIGHEST_ADDRESS: u8 = 15;

/// A board begins its reply at most this long after the last byte of the command, us.
pub const TURNAROUND_MICROSECONDS: u32 = 100;
