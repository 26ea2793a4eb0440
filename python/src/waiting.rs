//! Waiting without the interpreter lock, in slices, so that Ctrl-C ends the wait.

use crate::errors::Refusal;
use pyo3::prelude::*;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread::Builder;
use std::time::Duration;
use sun2xp::HandError;
use sun2xp::realtime::SignalsBlocked;

/// Longest time between two checks for signals that Python has received.
pub const SLICE: Duration = Duration::from_millis(20);

/// Stack of a thread that makes a call. Opening a hand needs more than 512 KiB.
const STACK_BYTES: usize = 2 << 20;

/// Interval at which a condition is polled.
const POLL_INTERVAL: Duration = Duration::from_millis(1);

/// Calls `work` in a thread of its own, because `work` cannot be interrupted, and waits for its result. If the handler
/// of a signal raises an exception, the wait ends with this exception, and the result of the thread is dropped when it
/// comes.
pub fn in_thread<T: Send + 'static>(py: Python<'_>, work: impl FnOnce() -> T + Send + 'static) -> PyResult<T> {
    let (sender, mut receiver) = channel();
    let doing = "start a thread for the call";
    // The new thread inherits the mask that blocks all signals, so only the threads of the program receive signals.
    let blocked = SignalsBlocked::all();
    let started = Builder::new().name("sun2xp call".into()).stack_size(STACK_BYTES).spawn(move || {
        // If nobody waits any more, the result is dropped here. This closes the hand if the result is a hand.
        let _ = sender.send(work());
    });
    drop(blocked);
    started.map_err(|source| Refusal::Hand(HandError::System { doing, source }).raise(py))?;
    loop {
        let (received, back) = py.detach(move || (receiver.recv_timeout(SLICE), receiver));
        match received {
            Ok(result) => return Ok(result),
            Err(RecvTimeoutError::Timeout) => py.check_signals()?,
            Err(RecvTimeoutError::Disconnected) => return Err(Refusal::Defect.raise(py)),
        }
        receiver = back;
    }
}

/// Calls `poll` until it returns a result, without the interpreter lock.
pub fn until<T: Send>(py: Python<'_>, mut poll: impl FnMut() -> Result<Option<T>, Refusal> + Send) -> PyResult<T> {
    loop {
        let found = py.detach(|| {
            for _ in 0..SLICE.as_millis() / POLL_INTERVAL.as_millis() {
                if let Some(found) = poll()? {
                    return Ok(Some(found));
                }
                std::thread::sleep(POLL_INTERVAL);
            }
            Ok(None)
        });
        match found.map_err(|refusal: Refusal| refusal.raise(py))? {
            Some(found) => return Ok(found),
            None => py.check_signals()?,
        }
    }
}

/// Converts a time in s. Returns `None`, which means no limit, if `seconds` is `None` or is too long for a `Duration`.
pub fn duration(py: Python<'_>, name: &str, seconds: Option<f64>) -> PyResult<Option<Duration>> {
    match seconds {
        None => Ok(None),
        Some(seconds) if seconds >= 0.0 => Ok(Duration::try_from_secs_f64(seconds).ok()),
        Some(seconds) => Err(Refusal::Argument(format!("{name} is {seconds} s: pass a time of 0 s or more")).raise(py)),
    }
}

/// Returns the time for which a set point is valid. `None` stands for the configured time. A time that is too long for
/// a `Duration` becomes `Duration::MAX`. No servo runs for that long, so the set point does not expire.
pub fn validity(py: Python<'_>, seconds: Option<f64>) -> PyResult<Option<Duration>> {
    Ok(duration(py, "valid", seconds)?.or(seconds.map(|_| Duration::MAX)))
}
