//! Brings slack tendons under tension while the joints stay where they are.

pub(crate) mod slack;
