//! The parallel stiffness controller of the Stanford/JPL hand (COINS TR 90-48, 1990) as a library.
//!
//! C planners use `include/Sun2Xp.h`; this is the Rust side of the same house. Start reading at [`hand`].

#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod board;
pub mod calibration;
mod capi;
pub mod control;
pub mod files;
pub mod finger;
pub mod hand;
pub mod model;
pub mod plant;
pub mod realtime;
pub mod simulated;
pub mod stability;

/// The matrices of the public signatures.
pub use nalgebra;
