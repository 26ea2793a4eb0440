//! Touch: fetches the tactile events of a finger from its board when the line has time, and keeps the newest reading of
//! every tactile element.

mod elements;
mod fetching;

pub use elements::{Elements, TouchReading};
pub(super) use fetching::TouchFetching;
