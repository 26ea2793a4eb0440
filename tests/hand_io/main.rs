//! Hands whose hardware the program provides: the physics of a finger stands behind the trait.

mod board;
mod hand;
mod plant_io;
#[path = "../common/settling.rs"]
mod settling;
