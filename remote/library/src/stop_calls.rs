//! Carries out sun2xp_stop_all, which a signal handler may call. The call increments a counter, which a thread polls.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Weak};
use std::thread::{self, Builder};
use std::time::Duration;
use sun2xp::capi::RemoteRefusal;
use sun2xp::finger::stop_calls;
use sun2xp::realtime::{SignalsBlocked, with_remedy};

use crate::refusals::system;

/// Interval at which the thread looks at the count.
const INTERVAL: Duration = Duration::from_millis(5);

/// A hand that the thread can stop.
pub(crate) trait Stoppable: Send + Sync + 'static {
    /// Stops every finger. Returns false if the stop may not have arrived, and must be repeated.
    fn stop_every_finger(&self) -> bool;
}

/// A thread that carries out the stop calls while both this value and the hand exist.
pub(crate) struct StopCalls(Arc<AtomicBool>);

impl StopCalls {
    /// Starts the thread. `seen` is the number of calls at the beginning of the opening. Calls since then stop the hand
    /// too.
    pub fn watch<H: Stoppable>(hand: Weak<H>, mut seen: u32) -> Result<Self, RemoteRefusal> {
        let ended = Arc::new(AtomicBool::new(false));
        let must_end = ended.clone();
        // The thread inherits this mask, so the planner's signal handlers run only in the planner's own threads.
        let _blocked = SignalsBlocked::all();
        let started = Builder::new().name("sun2xp stop".into()).spawn(move || {
            while !must_end.load(Ordering::Acquire) {
                let calls = stop_calls();
                if calls != seen {
                    let Some(hand) = hand.upgrade() else { return };
                    if hand.stop_every_finger() {
                        seen = calls;
                    }
                }
                thread::sleep(INTERVAL);
            }
        });
        started.map(|_| Self(ended)).map_err(|error| {
            let errno = error.raw_os_error().unwrap_or(libc::EIO);
            system(errno, &format!("cannot start a thread: {}", with_remedy(&error)))
        })
    }
}

impl Drop for StopCalls {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::{Sender, channel};

    struct Informed {
        to: Sender<()>,
        /// Whether the next stop arrives. Every later stop arrives.
        arrives: AtomicBool,
    }

    impl Stoppable for Informed {
        fn stop_every_finger(&self) -> bool {
            let _ = self.to.send(());
            self.arrives.swap(true, Ordering::Relaxed)
        }
    }

    /// Makes a stop call during the opening, and waits until the hand was asked to stop this many times.
    fn stopped(arrives: bool, times: usize) {
        let seen = stop_calls();
        sun2xp::stop_all();
        let (to, stopped) = channel();
        let hand = Arc::new(Informed { to, arrives: AtomicBool::new(arrives) });
        let watch = StopCalls::watch(Arc::downgrade(&hand), seen);
        assert!(watch.is_ok());
        for _ in 0..times {
            assert_eq!(stopped.recv_timeout(Duration::from_secs(20)), Ok(()));
        }
    }

    /// One test makes all calls, because every hand of a process reacts to them.
    #[test]
    fn a_call_during_the_opening_stops_the_hand_until_the_stop_has_arrived() {
        stopped(true, 1);
        stopped(false, 2);
    }
}
