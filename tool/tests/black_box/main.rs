//! The black box: recorded cycles are recomputed to the last bit, and an altered bit is found.

mod files;
#[allow(dead_code)]
#[path = "../../../tests/common/pauses.rs"]
mod pauses;
mod recording;
mod rig;
