//! The calls that read. None of them waits.

use crate::RemoteHand;
use crate::clock::now;
use crate::error::RemoteError;
use crate::events::RemoteEvents;
use crate::progress::RemoteProgress;
use crate::view::RemoteStatistics;
use sun2xp_remote_protocol::{FingerStatus, Record, Status};

/// The state of a fingertip.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RemoteFingerTip {
    /// Position in the finger's frame, cm.
    pub tip: [f64; 3],
    /// Force on the touched object in the finger's frame, N.
    pub force: [f64; 3],
    /// Tendon tensions, N.
    pub tensions: [f64; 4],
    /// Whether the finger touches something.
    pub touching: bool,
}

impl RemoteHand {
    /// Measured joint angles of finger 1, 2 or 3, rad.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, if the finger has stopped, or if the angles are older than
    /// `stale_ms`.
    pub fn position(&self, finger: i32) -> Result<[f64; 3], RemoteError> {
        self.link.shared.lock().moving(finger, now()).map(|record| record.joints)
    }

    /// Position and force of the tip, and the tendon tensions, of finger 1, 2 or 3.
    ///
    /// # Errors
    /// Returns the errors of [`RemoteHand::position`].
    pub fn fingertip(&self, finger: i32) -> Result<RemoteFingerTip, RemoteError> {
        let exchange = self.link.shared.lock();
        let &Record { tip, force, tensions, touching, .. } = exchange.moving(finger, now())?;
        Ok(RemoteFingerTip { tip, force, tensions, touching })
    }

    /// The newest cycle of finger 1, 2 or 3, whether the finger has stopped or not.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if the cycle is older than `stale_ms`. For a finger that has
    /// stopped, the age of the newest State counts.
    pub fn record(&self, finger: i32) -> Result<Record, RemoteError> {
        self.link.shared.lock().record(finger, now()).copied()
    }

    /// What finger 1, 2 or 3 has done since the newest command of this client.
    ///
    /// # Errors
    /// Returns the errors of [`RemoteHand::position`]. Returns an error if this client does not own the hand, or if the
    /// hand has refused a command and no call has reported this refusal yet.
    pub fn progress(&self, finger: i32) -> Result<RemoteProgress, RemoteError> {
        self.link.shared.lock().progress(finger, now())
    }

    /// The newest Status. The server sends one each second.
    ///
    /// # Errors
    /// Returns an error if nothing was received from the hand for 3 s.
    pub fn status(&self) -> Result<Status, RemoteError> {
        self.link.shared.lock().status(now()).cloned()
    }

    /// The status of finger 1, 2 or 3 in the newest Status.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, or if nothing was received from the hand for 3 s.
    pub fn finger_status(&self, finger: i32) -> Result<FingerStatus, RemoteError> {
        let exchange = self.link.shared.lock();
        exchange.status(now())?;
        exchange.finger_status(finger).cloned()
    }

    /// Returns the counts of what this client has received and sent since it opened the hand.
    #[must_use]
    pub fn statistics(&self) -> RemoteStatistics {
        self.link.shared.lock().view.statistics
    }

    /// Returns a queue of all events from now on.
    #[must_use]
    pub fn events(&self) -> RemoteEvents {
        self.link.shared.events.subscribe()
    }
}
