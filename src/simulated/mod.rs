//! Simulated boards: they answer the board protocol for simulated fingers, either at a pseudo-terminal in real time, or
//! in memory in simulated time.

mod board;
mod cable;
mod coupled_ports;
mod defects;
mod finger;
mod line;
mod pace;
mod pads;
mod port;
mod pseudo_terminal;
mod scene;
mod shared_time;
mod wiring;

pub use board::{SimulatedBoard, SimulatedBoardError};
pub use cable::SimulatedCable;
pub use coupled_ports::{CoupledPorts, CoupledPortsError, ObjectView};
pub use defects::{Defect, WiredPart};
pub use finger::SimulatedFinger;
pub use line::LineFault;
pub use pace::{Pace, PacedTime};
pub use port::SimulatedPort;
pub use scene::{ObjectState, Scene};
pub use wiring::Wiring;
