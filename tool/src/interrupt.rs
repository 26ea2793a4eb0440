//! The request to end: SIGINT, as Ctrl-C sends it, SIGTERM, SIGHUP or SIGQUIT.

use signal_hook::consts::{SIGHUP, SIGINT, SIGQUIT, SIGTERM};
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Notes whether the end of the program has been requested. Work that checks it can end in an orderly way.
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Replaces the default action of the signals, which ends the process.
    ///
    /// # Errors
    /// Returns an error if the system refuses to watch the signals.
    pub fn watch() -> io::Result<Self> {
        let requested = Arc::new(AtomicBool::new(false));
        for signal in [SIGHUP, SIGINT, SIGQUIT, SIGTERM] {
            signal_hook::flag::register(signal, requested.clone())?;
        }
        Ok(Self(requested))
    }

    /// Returns whether the end has been requested.
    pub fn requested(&self) -> bool {
        self.0.load(Ordering::Acquire)
    }
}
