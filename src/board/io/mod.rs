//! Hardware without a serial board: the interface that a program implements for its own hardware, and a transport that
//! plays the part of the board in memory.

mod finger_io;
mod hardware;
mod identity;
mod io_board;
mod tension_scale;

pub use finger_io::{FingerIo, HandIo, IoCommand, IoFaults, IoProperties, IoSample, IoTerms};
pub use io_board::IoBoard;
pub use tension_scale::{DEFAULT_TENSION_UNIT, TensionScale, ZERO_COUNT};
