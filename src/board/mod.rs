//! The host's end of the cable: the protocol of `docs/board-protocol.md`, the link that uses it, and the serial ports.

mod capacity;
mod connection;
pub(crate) mod descriptor;
mod io;
mod link;
mod link_error;
mod port;
mod port_error;
pub mod protocol;
mod terms;
mod transport;

pub use capacity::{TooFast, USABLE_SHARE, capacity, exchange_microseconds, tactile_microseconds, tactile_requests};
pub use connection::Connection;
pub use io::{
    DEFAULT_TENSION_UNIT, FingerIo, HandIo, IoBoard, IoCommand, IoFaults, IoProperties, IoSample, IoTerms,
    TensionScale, ZERO_COUNT,
};
pub use link::{Allowance, Arrival, Link, LinkCounters, OutgoingCommand, OutgoingRequest, Received};
pub use link_error::LinkError;
pub use port::Port;
pub use port_error::PortError;
pub use terms::{Terms, TermsError};
pub use transport::Transport;
