//! Files on disk, handled so that no path that a person or a program names can hang the library or exhaust its memory.

mod regular;

pub use regular::{open_regular_file, read_regular_file};
