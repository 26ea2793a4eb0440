//! Tests of configuration files: what they can express and what is refused.

mod arrays;
mod hostile;
mod named_hands;
mod reading;
mod reference;
mod sharing;
