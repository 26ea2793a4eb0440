//! The request to end: SIGINT, as Ctrl-C sends it, SIGTERM or SIGHUP.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use tokio::signal::unix::{SignalKind, signal};

/// Notes requests to end from now on. Work that looks at it can end in an orderly way.
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Replaces the default action of the signals, which ends the process.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread or watch the signals.
    pub fn watch() -> io::Result<Self> {
        let requested = Arc::new(AtomicBool::new(false));
        let noted = requested.clone();
        let runtime = tokio::runtime::Builder::new_current_thread().enable_io().build()?;
        let mut signals = {
            let _context = runtime.enter();
            let of = |kind| signal(kind);
            [of(SignalKind::interrupt())?, of(SignalKind::terminate())?, of(SignalKind::hangup())?]
        };
        let wait = move || {
            runtime.block_on(async {
                let [interrupt, terminate, hangup] = &mut signals;
                tokio::select! {
                    _ = interrupt.recv() => {}
                    _ = terminate.recv() => {}
                    _ = hangup.recv() => {}
                }
            });
            noted.store(true, Ordering::Release);
        };
        std::thread::Builder::new().name("signals".into()).spawn(wait)?;
        Ok(Self(requested))
    }

    /// Whether the end has been requested.
    pub fn requested(&self) -> bool {
        self.0.load(Ordering::Acquire)
    }
}
