//! Bringing slack tendons under tension with the joints left where they are.

pub(crate) mod slack;
