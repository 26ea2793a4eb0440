//! A hand on another machine: opens, acquires and closes it.

mod reading;
mod requests;
mod sending;

pub use reading::RemoteFingerTip;

use crate::configuration::RemoteConfiguration;
use crate::error::RemoteError;
use crate::link::Link;
use std::process::id;
use std::sync::Arc;
use sun2xp_remote_protocol::{Finger, HandName};

/// A hand that `sun2xp serve` offers. A process can have several. All functions may be called from several threads.
///
/// Dropping the hand releases it: every finger goes to its end state. If the process dies instead, the hand holds its
/// pose softly, and later goes to its end state.
///
/// Zenoh connects again by itself after the connection was lost. The ownership does not come back by itself:
/// [`RemoteHand::reopen`] acquires the hand again.
#[must_use = "a hand that is dropped is released"]
pub struct RemoteHand {
    pub(crate) link: Arc<Link>,
    /// The process that has the threads. A forked child inherits this value, but not the threads.
    process: u32,
}

impl RemoteHand {
    /// Connects to the hand and acquires it. Fingers that have stopped are recovered. Returns when the pose of every
    /// finger is known.
    ///
    /// # Errors
    /// Returns an error if the configuration or a certificate cannot be used, if the hand cannot be reached, if another
    /// client owns it and `take_over` is false, or if a finger does not recover.
    pub fn open(configuration: &RemoteConfiguration) -> Result<Self, RemoteError> {
        let hand = Self::watch(configuration)?;
        hand.link.acquire(true)?;
        Ok(hand)
    }

    /// Connects to the hand to read it. This client does not acquire the hand, unless [`RemoteHand::reopen`] or
    /// [`RemoteHand::acquire`] is called. There may be any number of watchers.
    ///
    /// # Errors
    /// Returns an error if the configuration or a certificate cannot be used, or if the hand cannot be reached.
    pub fn watch(configuration: &RemoteConfiguration) -> Result<Self, RemoteError> {
        Ok(Self { link: Arc::new(Link::open(configuration)?), process: id() })
    }

    /// Acquires the hand, for example after its ownership was lost. Fingers that have stopped are recovered. Set points
    /// that were sent before are not sent again. Waits for the answer.
    ///
    /// # Errors
    /// Returns an error if the hand cannot be reached, if another client owns it and `take_over` is false, or if a
    /// finger does not recover.
    pub fn reopen(&self) -> Result<(), RemoteError> {
        self.link.acquire(true)
    }

    /// Acquires the hand as [`RemoteHand::reopen`] does, but recovers no finger. Call [`RemoteHand::recover`] for each
    /// finger that may move.
    ///
    /// # Errors
    /// Returns an error if the hand cannot be reached, or if another client owns it and `take_over` is false.
    pub fn acquire(&self) -> Result<(), RemoteError> {
        self.link.acquire(false)
    }

    /// Releases the hand: every finger goes to its end state. The hand can still be read, and acquired again. Waits for
    /// the answer.
    ///
    /// # Errors
    /// Returns an error if the hand was owned and the server did not confirm the release. Then the hand goes to its end
    /// state by itself, because the server receives no more Target messages.
    pub fn release(&self) -> Result<(), RemoteError> {
        self.link.release()
    }

    /// Releases the hand: every finger goes to its end state. Dropping the hand does the same, but returns no error.
    ///
    /// # Errors
    /// Returns an error if the hand was owned and the server did not confirm the release. Then the hand goes to its end
    /// state by itself, because the server receives no more Target messages.
    pub fn close(self) -> Result<(), RemoteError> {
        self.link.release()
    }

    /// Whether this client owns the hand, as far as it knows.
    #[must_use]
    pub fn is_owner(&self) -> bool {
        self.link.shared.lock().outbox.ownership().is_ok()
    }

    /// The name of the hand.
    #[must_use]
    pub fn name(&self) -> &HandName {
        &self.link.configuration.hand
    }

    /// The fingers of the hand.
    #[must_use]
    pub fn fingers(&self) -> Vec<Finger> {
        let exchange = self.link.shared.lock();
        let has =
            |finger: &Finger| exchange.view.status().is_some_and(|status| status.fingers[finger.index()].is_some());
        Finger::ALL.into_iter().filter(has).collect()
    }
}

impl Drop for RemoteHand {
    fn drop(&mut self) {
        if self.process != id() {
            // This is a forked child. The session and the threads belong to its parent, so the link is never dropped.
            std::mem::forget(self.link.clone());
            return;
        }
        // Without an answer, the hand goes to its end state, because the server receives no more Target messages.
        let _ = self.link.release();
    }
}
