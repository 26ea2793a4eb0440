//! `sun2xp export` and `sun2xp plot`: the numbers and the pictures are those of the recording.

#[path = "../common/damage.rs"]
mod damage;
mod export;
mod plot;
mod recorded;
