//! The request to end: SIGINT (Ctrl-C), SIGTERM, SIGHUP or SIGQUIT. A program that nohup has started ignores SIGHUP.

use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use sun2xp::realtime::is_ignored;

/// The request, which all parts of the program share. `None` before the signals are watched.
static REQUESTED: Mutex<Option<Arc<AtomicBool>>> = Mutex::new(None);

/// Notes whether the end of the program has been requested. Work that checks it can end in an orderly way.
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Replaces the default action of the signals, which ends the process. An ignored SIGHUP stays ignored. If the
    /// signals are already watched, the result also reports a request that has come since the first call.
    ///
    /// # Errors
    /// Returns an error if the system refuses to watch the signals.
    pub fn watch() -> io::Result<Self> {
        let mut shared = REQUESTED.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(requested) = &*shared {
            return Ok(Self(requested.clone()));
        }
        let requested = Arc::new(AtomicBool::new(false));
        // A person who starts a recorder with nohup wants it to stay when the terminal closes.
        let hangup = (!is_ignored(SIGHUP)).then_some(SIGHUP);
        for signal in hangup.into_iter().chain([SIGINT, SIGQUIT, SIGTERM]) {
            signal_hook::flag::register(signal, requested.clone())?;
        }
        *shared = Some(requested.clone());
        Ok(Self(requested))
    }

    /// Returns whether the end has been requested.
    pub fn requested(&self) -> bool {
        self.0.load(Ordering::Acquire)
    }
}
