//! A descriptor that is readable while a queue has events. An ordinary thread of the library makes it readable, so that
//! the servos make no system call for the descriptor.
#![allow(unsafe_code, reason = "an eventfd")]

use super::queue_state::QueueState;
use crate::board::descriptor::Descriptor;
use crate::realtime::{Mutex, Priority, spawn};
use std::io;
use std::os::fd::RawFd;
use std::process::id;
use std::sync::{Arc, Condvar, PoisonError};
use std::thread::JoinHandle;

/// The descriptor and its thread.
pub(super) struct Readiness {
    shared: Arc<Shared>,
    queue: Arc<QueueState>,
    thread: Option<JoinHandle<()>>,
    /// The process that has the thread.
    process: u32,
}

struct Shared {
    descriptor: Descriptor,
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    /// Whether the descriptor is readable.
    readable: bool,
    /// Whether the hand is closed. The descriptor then stays readable.
    closed: bool,
    stop: bool,
}

impl Readiness {
    /// Creates the descriptor, and starts the thread.
    pub fn start(queue: Arc<QueueState>) -> io::Result<Self> {
        // SAFETY: the call takes no pointer.
        let descriptor = Descriptor::opened(unsafe { libc::eventfd(0, libc::EFD_CLOEXEC | libc::EFD_NONBLOCK) })?;
        let shared = Arc::new(Shared { descriptor, state: Mutex::default(), changed: Condvar::new() });
        let (of_thread, followed) = (shared.clone(), queue.clone());
        let thread = spawn("sun2xp ready", Priority::default(), move |_| of_thread.follow(&followed))?;
        Ok(Self { shared, queue, thread: Some(thread), process: id() })
    }

    pub fn number(&self) -> RawFd {
        self.shared.descriptor.number()
    }

    /// Makes the descriptor unreadable until the next event. The caller has found no event in the queue.
    pub fn queue_is_empty(&self) {
        let mut state = self.shared.state.lock();
        if state.readable && !state.closed {
            self.shared.make_unreadable();
            state.readable = false;
            self.shared.changed.notify_one();
        }
    }
}

impl Shared {
    /// Adds 1 to the counter of the eventfd. This never blocks, because the counter is far from its limit.
    fn make_readable(&self) {
        if self.descriptor.is_own() {
            let one = 1u64.to_ne_bytes();
            // SAFETY: the buffer has the eight bytes that an eventfd takes.
            unsafe { libc::write(self.descriptor.number(), one.as_ptr().cast(), one.len()) };
        }
    }

    /// Sets the counter of the eventfd to 0. This never blocks.
    fn make_unreadable(&self) {
        if self.descriptor.is_own() {
            let mut count = [0u8; 8];
            // SAFETY: the buffer has room for the eight bytes that an eventfd gives.
            unsafe { libc::read(self.descriptor.number(), count.as_mut_ptr().cast(), count.len()) };
        }
    }

    fn follow(&self, queue: &QueueState) {
        let stops = || self.state.lock().stop;
        loop {
            let ready = queue.wait_until(u64::MAX, stops);
            let mut state = self.state.lock();
            if state.stop {
                return;
            }
            self.make_readable();
            state.readable = true;
            state.closed = !ready;
            if state.closed {
                return;
            }
            while state.readable && !state.stop {
                state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
            }
        }
    }
}

impl Drop for Readiness {
    fn drop(&mut self) {
        if self.process != id() {
            // This is a forked child, which does not have the thread.
            std::mem::forget(self.thread.take());
            return;
        }
        self.shared.state.lock().stop = true;
        self.shared.changed.notify_one();
        self.queue.source.readers.notify();
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
