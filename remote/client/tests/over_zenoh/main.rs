//! Tests the client against a small server, over Zenoh on loopback.

mod calls;
mod fake_hand;
mod latency;
mod leaks;
mod requests;
mod server;
