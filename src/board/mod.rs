//! The board at the other end of the cable: the protocol of `docs/board-protocol.md`, the serial link that speaks it, and a
//! simulated board that answers.

mod capacity;
mod descriptor;
mod link;
mod link_error;
mod port;
mod port_error;
pub mod protocol;
mod pseudo_terminal;
mod simulated_board;
mod simulated_cable;
mod simulated_defects;
mod simulated_finger;
mod simulated_line;
mod simulated_pace;
mod simulated_port;
mod terms;
mod transport;

pub use capacity::{TooFast, USABLE_SHARE, capacity, exchange_microseconds};
pub use link::{Allowance, Link, LinkCounters, OutgoingCommand, Received};
pub use link_error::LinkError;
pub use port::Port;
pub use port_error::PortError;
pub use simulated_board::{SimulatedBoard, SimulatedBoardError};
pub use simulated_cable::SimulatedCable;
pub use simulated_defects::Defect;
pub use simulated_finger::SimulatedFinger;
pub use simulated_line::LineFault;
pub use simulated_pace::{Pace, PacedTime};
pub use simulated_port::SimulatedPort;
pub use terms::{Terms, TermsError};
pub use transport::Transport;
