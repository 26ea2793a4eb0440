//! `sun2xp export` and `sun2xp plot`: the numbers and the pictures are those of the recording.

mod export;
mod plot;
mod recorded;
