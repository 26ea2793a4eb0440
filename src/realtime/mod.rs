//! Clock, periods, priorities, locked memory and timing figures of the servo threads.

mod clock;
mod follower;
mod limits;
mod memory;
mod period;
mod response_time;
mod threads;
mod timing;
mod wake_up;

pub use clock::{Clock, MonotonicClock, now};
pub use follower::Follower;
pub use limits::{remedy, with_remedy};
pub use memory::Memory;
pub use period::Schedule;
pub use response_time::{PeriodicThread, Response, response_times};
pub use threads::{Priority, Realtime, lock_stack, spawn, touch_stack};
pub use timing::{CycleTiming, Distribution, Histograms, Stage};
pub use wake_up::{WakeUp, measure_wake_up};
