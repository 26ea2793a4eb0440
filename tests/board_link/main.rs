//! The link and the simulated board, in memory and on simulated time.

mod disturbances;
mod handshake;
mod other_end;
mod requests;
mod rig;
mod states;
