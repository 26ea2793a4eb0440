//! Recordings: MCAP files with the telemetry of a hand. Each file can be read by itself.
//!
//! `/finger1/cycle` to `/finger3/cycle` have the samples, for every MCAP reader that supports ROS 2. `/finger1/replay`
//! and so on have exact copies of the telemetry messages. This program reads the cycles back from these copies. The
//! other channels are JSON. docs/recordings.md describes the format.

mod altered;
mod black_box;
mod cdr;
mod channels;
mod entry;
mod reading;
#[cfg(test)]
mod tests;
mod writing;

pub use altered::or_by;
pub use entry::{Entry, Item};
pub use reading::Recording;
pub use writing::RecordingWriter;
