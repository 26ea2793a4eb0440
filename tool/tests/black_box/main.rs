//! The black box: what is recorded while a hand runs is computed again to the last bit, and a changed bit is found.

mod files;
#[allow(dead_code)]
#[path = "../../../tests/common/pauses.rs"]
mod pauses;
mod recording;
mod rig;
