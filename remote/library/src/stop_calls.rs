//! Carries out sun2xp_stop_all, which a signal handler may call: the call counts, and a thread sees the count.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Weak};
use std::thread::{self, Builder};
use std::time::Duration;
use sun2xp::capi::RemoteRefusal;
use sun2xp::finger::stop_calls;
use sun2xp::realtime::SignalsBlocked;

use crate::refusals::system;

/// Interval at which the thread looks at the count.
const INTERVAL: Duration = Duration::from_millis(5);

/// What the thread stops.
pub(crate) trait Stoppable: Send + Sync + 'static {
    /// Stops every finger.
    fn stop_every_finger(&self);
}

/// A thread that carries out the stop calls while both this value and the hand exist.
pub(crate) struct StopCalls(Arc<AtomicBool>);

impl StopCalls {
    /// Starts the thread. Calls from now on stop the hand.
    pub fn watch<H: Stoppable>(hand: Weak<H>) -> Result<Self, RemoteRefusal> {
        let ended = Arc::new(AtomicBool::new(false));
        let seen_by_thread = ended.clone();
        let mut seen = stop_calls();
        // The thread inherits this mask, so the planner's signal handlers run only in the planner's own threads.
        let _blocked = SignalsBlocked::all();
        let started = Builder::new().name("sun2xp stop".into()).spawn(move || {
            while !seen_by_thread.load(Ordering::Acquire) {
                let calls = stop_calls();
                if calls != seen {
                    seen = calls;
                    let Some(hand) = hand.upgrade() else { return };
                    hand.stop_every_finger();
                }
                thread::sleep(INTERVAL);
            }
        });
        started.map(|_| Self(ended)).map_err(|error| system(&format!("cannot start a thread: {error}")))
    }
}

impl Drop for StopCalls {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
    }
}
