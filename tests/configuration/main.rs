//! Configuration files: what they can say, and what is refused.

mod arrays;
mod hostile;
mod reading;
mod reference;
mod sharing;
