//! Timed motion of a set point: its derivatives, the paths that it follows, and the interpolation of set points that
//! arrive at a low rate. A servo changes the set point of a cycle with these before the controller runs.

mod derivatives;
mod follower;
mod interpolation;

pub use derivatives::Motion;
pub use follower::{Follower, PathTable, TimedStiffness};
pub use interpolation::{Interpolation, InterpolationState};
