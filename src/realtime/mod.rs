//! Real-time support for the servo threads: clock, periods, priorities, locked memory and timing statistics. This
//! module also keeps the code of this library and the planner's code apart with respect to signals, thread cancellation
//! and the floating-point environment.

pub(crate) mod atomics;
mod cancellation;
mod clock;
mod delegated_call;
mod event_count;
mod floating_point;
mod follower;
mod free_memory;
mod futex;
mod last_thread;
mod limits;
mod locks;
mod memory;
mod pages;
mod period;
mod response_time;
mod ring;
mod signals;
mod standard_error;
mod thread_local_data;
mod threads;
mod timing;
mod triple_buffer;
mod wake_up;

pub use cancellation::{DeferredCancellation, NoCancellation};
pub use clock::{Clock, MonotonicClock, boot_time, clock_offset, now, seconds_since_1970};
pub use delegated_call::DelegatedCall;
pub use event_count::EventCount;
pub use floating_point::Environment;
pub use follower::Follower;
pub use free_memory::is_memory_free;
pub use last_thread::PlannerWatch;
pub use limits::{remedy, with_remedy, with_terminal_remedy};
pub use locks::{Mutex, RwLock, try_for};
pub use memory::LockedMemory;
pub use pages::{Pages, SharedPages};
pub use period::Schedule;
pub use response_time::{PeriodicThread, Response, response_times};
pub use ring::{Consumer, Producer, ring};
pub use signals::{SignalsBlocked, is_ignored};
pub use standard_error::{MessageReceiver, Severity, offer_messages_to, report};
pub use threads::{LockedStack, Priority, RealtimeRefusals, spawn, touch_stack};
pub use timing::{CycleStage, CycleTiming, Distribution, Histograms};
pub use triple_buffer::{Input, Output, triple_buffer, triple_buffer_of};
pub use wake_up::{WakeUp, measure_wake_up};
