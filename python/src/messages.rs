//! Messages of the library for the module `logging` of Python.
//!
//! Threads of the library send messages while they hold locks. If such a thread waited for the interpreter lock, it
//! could wait for a Python thread that waits for its locks. Therefore the messages pass through a queue to a thread of
//! Python (sun2xp/_log.py).

use crate::fork;
use crate::waiting::SLICE;
use parking_lot::{Condvar, Mutex};
use pyo3::prelude::*;
use std::collections::VecDeque;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};
use sun2xp::realtime::{Severity, offer_messages_to};

/// Largest number of messages that wait. Further ones go to standard error.
const CAPACITY: usize = 1000;

/// Longest time for which the opening of a hand waits until the messages are in the log.
const LONGEST_FLUSH: Duration = Duration::from_secs(1);

/// The value of `fork::generation` in the process that has the thread of Python. No process has the initial value.
static OWNER: AtomicU32 = AtomicU32::new(u32::MAX);

struct Messages {
    waiting: VecDeque<(i32, String)>,
    /// Number of messages that were sent to the thread of Python.
    sent: u64,
    /// Number of messages that the thread of Python has taken.
    taken: u64,
    /// Number of messages that the thread of Python has logged.
    logged: u64,
    /// Whether the thread of Python takes messages.
    open: bool,
}

static MESSAGES: Mutex<Messages> =
    Mutex::new(Messages { waiting: VecDeque::new(), sent: 0, taken: 0, logged: 0, open: false });

/// Signals that a message has come, that messages were logged, or that `open` became false.
static CHANGED: Condvar = Condvar::new();

/// Begins to take messages for the thread of Python, which calls `next_message` until it returns None.
#[pyfunction]
pub fn take_messages() {
    OWNER.store(fork::generation(), Ordering::Relaxed);
    MESSAGES.lock().open = true;
    offer_messages_to(receive);
}

/// Returns whether this process has the thread of Python. A forked child does not have it. In the child, a lock that
/// another thread of the parent held is never released, so check this before locking [`MESSAGES`].
fn has_thread() -> bool {
    OWNER.load(Ordering::Relaxed) == fork::generation()
}

/// Takes a message, or returns false if it must go to standard error.
fn receive(severity: Severity, text: &str) -> bool {
    if !has_thread() {
        return false;
    }
    let level = match severity {
        Severity::Refusal => 20, // logging.INFO
        Severity::Warning => 30, // logging.WARNING
    };
    let mut messages = MESSAGES.lock();
    if !messages.open || messages.waiting.len() >= CAPACITY {
        return false;
    }
    messages.waiting.push_back((level, text.into()));
    messages.sent += 1;
    CHANGED.notify_all();
    true
}

/// Waits for a message, and returns its level and its text. The next call also reports that this message has been
/// logged. Returns None after `end_messages`.
#[pyfunction]
pub fn next_message(py: Python<'_>) -> PyResult<Option<(i32, String)>> {
    loop {
        let found = py.detach(|| {
            let mut messages = MESSAGES.lock();
            messages.logged = messages.taken;
            CHANGED.notify_all();
            if messages.waiting.is_empty() && messages.open {
                CHANGED.wait(&mut messages);
            }
            let found = messages.waiting.pop_front();
            messages.taken += u64::from(found.is_some());
            (found, messages.open)
        });
        match found {
            (Some(message), _) => return Ok(Some(message)),
            (None, false) => return Ok(None),
            (None, true) => {}
        }
    }
}

/// Makes `next_message` return None after the messages that still wait. Later messages go to standard error.
#[pyfunction]
pub fn end_messages() {
    if has_thread() {
        MESSAGES.lock().open = false;
        CHANGED.notify_all();
    }
}

/// Waits until all messages are in the log, but at most for one second: a handler of the log may wait for the caller.
/// An exception that a signal handler raises ends the wait.
#[pyfunction]
pub fn flush_messages(py: Python<'_>) -> PyResult<()> {
    if !has_thread() {
        return Ok(());
    }
    let sent = MESSAGES.lock().sent;
    let deadline = Instant::now() + LONGEST_FLUSH;
    while !py.detach(|| are_logged(sent, deadline.min(Instant::now() + SLICE))) && Instant::now() < deadline {
        py.check_signals()?;
    }
    Ok(())
}

/// Waits until this number of messages is in the log, but not longer than until `deadline`. Returns whether there is
/// nothing more to wait for.
fn are_logged(sent: u64, deadline: Instant) -> bool {
    let mut messages = MESSAGES.lock();
    while messages.open && messages.logged < sent {
        if CHANGED.wait_until(&mut messages, deadline).timed_out() {
            return false;
        }
    }
    true
}
