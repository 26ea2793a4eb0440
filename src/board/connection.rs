//! The transports of an open hand: a serial port, or hardware that the program provides.

use super::io::IoBoard;
use super::port::Port;
use super::port_error::PortError;
use super::transport::Transport;

/// The connection to the hardware of one or more fingers.
#[derive(Debug)]
#[allow(clippy::large_enum_variant, reason = "a box would not be in the locked memory of the servo")]
pub enum Connection {
    /// A serial port with its board.
    Serial(Port),
    /// Hardware that the program provides, for one finger.
    Io(IoBoard),
}

impl Connection {
    /// Returns the serial port, if there is one.
    pub fn port(&self) -> Option<&Port> {
        match self {
            Self::Serial(port) => Some(port),
            Self::Io(_) => None,
        }
    }

    /// Returns whether the servo waits for the hardware, as [`IoProperties::in_step`](super::IoProperties) says.
    pub fn in_step(&self) -> bool {
        matches!(self, Self::Io(board) if board.in_step())
    }
}

impl From<Port> for Connection {
    fn from(port: Port) -> Self {
        Self::Serial(port)
    }
}

impl From<IoBoard> for Connection {
    fn from(board: IoBoard) -> Self {
        Self::Io(board)
    }
}

impl Transport for Connection {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        match self {
            Self::Serial(port) => port.write(bytes),
            Self::Io(board) => board.write(bytes),
        }
    }

    fn read_until(&mut self, buffer: &mut [u8], deadline: u64) -> Result<usize, PortError> {
        match self {
            Self::Serial(port) => port.read_until(buffer, deadline),
            Self::Io(board) => board.read_until(buffer, deadline),
        }
    }

    fn ready_at(&self) -> u64 {
        match self {
            Self::Serial(port) => port.ready_at(),
            Self::Io(board) => board.ready_at(),
        }
    }

    fn discard_input(&mut self) -> Result<(), PortError> {
        match self {
            Self::Serial(port) => port.discard_input(),
            Self::Io(board) => board.discard_input(),
        }
    }

    fn now(&self) -> u64 {
        match self {
            Self::Serial(port) => port.now(),
            Self::Io(board) => board.now(),
        }
    }
}
