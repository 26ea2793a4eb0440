//! Clock, periods, priorities and timing figures of the servo threads.

mod clock;
mod period;
mod response_time;
mod threads;
mod timing;

pub use clock::{Clock, MonotonicClock, now};
pub use period::Schedule;
pub use response_time::{PeriodicThread, Response, response_times};
pub use threads::{Priority, Realtime, spawn};
pub use timing::{CycleTiming, Distribution, Histograms, Stage};
