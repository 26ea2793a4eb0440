//! Timed motion of a set point: its derivatives, the paths that it follows, and the interpolation of set points that
//! arrive at a low rate. In every cycle, a servo applies these to the set point before the controller runs.

mod derivatives;
mod extent;
mod follower;
mod interpolation;

pub use derivatives::Motion;
pub use extent::PathExtent;
pub use follower::{Follower, PathTable, TimedStiffness};
pub use interpolation::{Interpolation, InterpolationState};
