//! The calls that wait for an answer of the server.

use crate::RemoteHand;
use crate::error::RemoteError;
use sun2xp_remote_protocol::{Action, Finger};

impl RemoteHand {
    /// Recovers finger 1, 2 or 3, or every finger, after a fault or a stop. Returns when the finger holds its pose.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, if this client does not own the hand, if the finger does not
    /// recover, or if the hand cannot be reached.
    pub fn recover(&self, finger: Option<i32>) -> Result<(), RemoteError> {
        self.request(Action::Recover, finger)
    }

    /// Brings finger 1, 2 or 3, or every finger, to its end state at once. Every client with the permission "read" or
    /// "command" at the server may do this, even if another client owns the hand.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, if the server does not give this client a permission, or if the
    /// hand cannot be reached.
    pub fn stop(&self, finger: Option<i32>) -> Result<(), RemoteError> {
        self.request(Action::Stop, finger)
    }

    /// Stops every finger as [`RemoteHand::stop`] does, for an emergency. No Targets are sent until the server has
    /// confirmed the stop. Without the confirmation, a hand that this client owns goes to its end state by itself,
    /// because no Targets arrive. A hand that another client owns still gets the Targets of that client, so it stops
    /// only if the stop reaches the server. If the hand cannot be reached, repeat the call until it succeeds, unless
    /// another client has taken the hand over.
    ///
    /// # Errors
    /// Returns an error if the server does not give this client a permission, or if the hand cannot be reached.
    pub fn emergency_stop(&self) -> Result<(), RemoteError> {
        self.link.shared.lock().outbox.hold(true);
        self.stop(None)?;
        self.link.shared.lock().outbox.hold(false);
        self.link.shared.wake();
        Ok(())
    }

    /// Zeros finger 1, 2 or 3. Returns when this is done, after up to ten minutes. The result is in force at the
    /// server.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, if this client does not own the hand, if the calibration fails, or
    /// if the hand cannot be reached.
    pub fn zero(&self, finger: i32) -> Result<(), RemoteError> {
        // In the protocol, zeroing has the name `calibrate`.
        self.request(Action::Calibrate, Some(finger))
    }

    /// Identifies finger 1, 2 or 3: measures its gauge gains, tendon stiffness and friction. Returns when this is done,
    /// after up to ten minutes. The result is in force at the server.
    ///
    /// # Errors
    /// Returns the errors of [`RemoteHand::zero`].
    pub fn identify(&self, finger: i32) -> Result<(), RemoteError> {
        self.request(Action::Identify, Some(finger))
    }

    fn request(&self, action: Action, finger: Option<i32>) -> Result<(), RemoteError> {
        let finger: Option<Finger> = finger.map(|number| self.link.shared.lock().finger(number)).transpose()?;
        if action != Action::Stop {
            self.link.shared.lock().owned()?;
        }
        let answer = self.link.request(action, finger, false)?;
        if action != Action::Stop {
            self.link.await_state_after(&answer);
        }
        Ok(())
    }
}
