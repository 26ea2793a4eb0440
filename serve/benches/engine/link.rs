//! The engines, and what each must do: carry messages of one length to a server and back.

use crate::Failure;
use crate::{stream, zenoh_link};
use std::path::Path;

/// What carries the messages.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Engine {
    Tcp,
    Rustls,
    ZenohTcp,
    ZenohTls,
}

impl Engine {
    pub const ALL: [Self; 4] = [Self::Tcp, Self::Rustls, Self::ZenohTcp, Self::ZenohTls];

    /// Returns the name in the table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tcp => "TCP",
            Self::Rustls => "TCP, rustls",
            Self::ZenohTcp => "Zenoh, TCP",
            Self::ZenohTls => "Zenoh, TLS",
        }
    }

    /// Returns the engine without Zenoh that protects the messages in the same way.
    pub fn baseline(self) -> Self {
        match self {
            Self::Tcp | Self::ZenohTcp => Self::Tcp,
            Self::Rustls | Self::ZenohTls => Self::Rustls,
        }
    }

    /// Connects to the server of this engine at a port of this machine.
    pub fn connect(self, port: u16, certificates: &Path) -> Result<Box<dyn Link>, Failure> {
        Ok(match self {
            Self::Tcp => Box::new(stream::connect_plain(port)?),
            Self::Rustls => Box::new(stream::connect_encrypted(port, certificates)?),
            Self::ZenohTcp => Box::new(zenoh_link::connect(port, None)?),
            Self::ZenohTls => Box::new(zenoh_link::connect(port, Some(certificates))?),
        })
    }
}

/// When a message of a flood is sent.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Sending {
    /// At once and separately, like a Target, the message with the set points of a remote planner.
    AtOnce,
    /// The engine may collect several messages and send them together.
    Together,
}

/// A connection to a server that answers.
pub trait Link {
    /// Sends a message and waits until the server has returned it.
    fn round_trip(&mut self, message: &[u8]) -> Result<(), Failure>;

    /// Sends a message many times, and waits until the server has received all of them. The server answers the last one
    /// only.
    fn flood(&mut self, message: &[u8], count: u64, sending: Sending) -> Result<(), Failure>;
}

/// The first byte of a message determines whether the server sends the message back, or only reads it.
pub const ANSWER: u8 = 0;
pub const ABSORB: u8 = 1;
