//! Hands whose hardware the program provides: here, a simulated finger implements the trait `FingerIo`.

mod board;
mod hand;
mod one_thread;
mod plant_io;
#[path = "../common/settling.rs"]
mod settling;
mod watchdog;
