//! Timed motion of a set point: its derivatives, the paths that it follows, and the interpolation of set points that
//! arrive at a low rate. In every cycle, before the controller runs, a servo moves the set point along its path or by
//! the interpolation.

mod derivatives;
mod extent;
mod follower;
mod interpolation;

pub use derivatives::Motion;
pub use extent::PathExtent;
pub use follower::{Follower, PathTable, TimedStiffness};
pub use interpolation::{Interpolation, InterpolationState};
