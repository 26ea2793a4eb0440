//! `sun2xp serve`: offers a hand to planners on other machines, over Zenoh (docs/remote-protocol.md). Only the program,
//! its tests and its benchmarks use this library.

#![deny(unsafe_code)]

pub mod acceptance;
pub mod access;
mod answers;
pub mod arguments;
mod authority;
pub mod certificates;
mod cycles;
pub mod desk;
pub mod endpoint;
mod epoch;
mod error;
mod fingers;
pub mod goal;
mod json;
pub mod lead;
pub mod output;
pub mod ownership;
mod places;
mod process;
mod publishing;
mod queries;
mod requests;
pub mod router;
pub mod server;
mod session;
pub mod settings;
mod shared;
pub mod silence;
mod status;

pub use error::ServeError;
