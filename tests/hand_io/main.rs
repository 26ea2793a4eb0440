//! Hands whose hardware the program provides: the physics of a finger stands behind the trait.

mod board;
mod hand;
mod one_thread;
mod plant_io;
#[path = "../common/settling.rs"]
mod settling;
