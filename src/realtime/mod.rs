//! What the servo threads need of the operating system.

pub mod clock;
