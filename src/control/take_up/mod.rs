//! Brings slack tendons under tension while the joints stay where they are.

pub(crate) mod progress;
pub(crate) mod slack;
pub(crate) mod tightening;
mod touch;
mod travel_servo;
