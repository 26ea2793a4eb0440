//! Touch: fetches the tactile events of a finger from its board in the periods in which the line has time for the
//! request, and keeps the newest reading of every tactile element.

mod elements;
mod fetching;

pub use elements::{Elements, TouchReading};
pub(super) use fetching::TouchFetching;
