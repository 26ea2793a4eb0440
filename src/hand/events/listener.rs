//! A thread that calls a planner's function with each event.

use super::queue::EventQueue;
use crate::finger::events::Event;
use crate::realtime::{Priority, spawn};
use std::io;
use std::process::id;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};

/// A function that gets each event of a hand. Dropping the listener waits until the function has returned, and the
/// function is not called again. If the function itself drops the listener, the drop does not wait.
#[must_use = "a listener that is dropped gets no events"]
pub struct EventListener {
    stop: Arc<AtomicBool>,
    queue: Arc<EventQueue>,
    thread: Option<JoinHandle<()>>,
    /// The process that has the thread.
    process: u32,
}

impl EventListener {
    /// Starts the thread.
    pub(super) fn start(queue: EventQueue, mut callback: impl FnMut(&Event, u64) + Send + 'static) -> io::Result<Self> {
        let (queue, stop) = (Arc::new(queue), Arc::new(AtomicBool::new(false)));
        let (events, ends) = (queue.clone(), stop.clone());
        let process = id();
        let thread = spawn("sun2xp events", Priority::default(), move |_| {
            let stops = || ends.load(Ordering::Acquire);
            while !stops() && events.state().wait_until(u64::MAX, stops) {
                let Some(event) = events.next().filter(|_| !stops()) else { continue };
                callback(&event, events.lost());
                if id() != process {
                    // The callback has forked, and this is the child. The events belong to its parent.
                    return;
                }
            }
        })?;
        Ok(Self { stop, queue, thread: Some(thread), process })
    }

    /// Returns the number of events that were lost because the function was too slow. The oldest are lost first.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.queue.lost()
    }

    /// Ends the listener without waiting for the function. A call that is running or about to begin is still completed.
    /// No later event causes a call.
    pub fn detach(mut self) {
        self.thread = None;
    }
}

impl Drop for EventListener {
    fn drop(&mut self) {
        if self.process != id() {
            // This is a forked child, which does not have the thread.
            std::mem::forget(self.thread.take());
            return;
        }
        self.stop.store(true, Ordering::Release);
        self.queue.state().source.readers.notify();
        if let Some(thread) = self.thread.take_if(|thread| thread.thread().id() != thread::current().id()) {
            // An error means that a panic of the function has ended the thread. There is nothing else to do.
            let _ = thread.join();
        }
    }
}
