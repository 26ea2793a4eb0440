//! The calls that send set points. Each call checks the planner's arguments, puts them into the outbox, and returns.

use crate::RemoteHand;
use crate::clock::now;
use crate::command::FingerCommand;
use crate::error::RemoteError;
use sun2xp_remote_protocol::PathPose;

impl RemoteHand {
    /// Sends theta_d, the desired angles of joints 0, 1 and 2, rad, of finger 1, 2 or 3.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, if an angle is NaN, infinite or beyond a joint limit, or if the
    /// hand cannot be commanded: this client does not own it, the finger has stopped, nothing was received from the
    /// hand for `stale_ms`, or the hand has refused an earlier set point. Such a refusal is reported only once.
    pub fn send_position(&self, finger: i32, joints: [f64; 3]) -> Result<(), RemoteError> {
        self.send_group(&[FingerCommand::new(finger).joints(joints)])
    }

    /// Sends Kx of finger 1, 2 or 3 in the finger's frame, N/cm: `rows[row][column]`.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, if Kx has an entry that is NaN or infinite, is not symmetric, has a
    /// negative eigenvalue or is above the bound, or if the hand cannot be commanded ([`RemoteHand::send_position`]).
    pub fn send_stiffness(&self, finger: i32, rows: [[f64; 3]; 3]) -> Result<(), RemoteError> {
        self.send_group(&[FingerCommand::new(finger).stiffness(rows)])
    }

    /// Sends the desired position of the tip of finger 1, 2 or 3 in the finger's frame, cm. The hand refuses a position
    /// that is out of reach; a later call reports this.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, if a number is NaN or infinite, or if the hand cannot be commanded
    /// ([`RemoteHand::send_position`]).
    pub fn send_tip(&self, finger: i32, tip: [f64; 3]) -> Result<(), RemoteError> {
        self.send_group(&[FingerCommand::new(finger).tip(tip)])
    }

    /// Sends the damping of finger 1, 2 or 3, relative to the damping that the controller chooses from the stiffness.
    /// The hand refuses a ratio that is outside its range; a later call reports this.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, if the ratio is NaN, infinite or negative, or if the hand
    /// cannot be commanded ([`RemoteHand::send_position`]).
    pub fn send_damping(&self, finger: i32, ratio: f64) -> Result<(), RemoteError> {
        self.send_group(&[FingerCommand::new(finger).damping(ratio)])
    }

    /// Sends a path to finger 1, 2 or 3: 1 to 32 poses with rising times, s. The times count from the moment at which
    /// the hand takes the path. The hand checks the path as a whole; a later call reports a refusal. A Kx or damping
    /// that is sent right after a path waits until the hand has confirmed the path.
    ///
    /// # Errors
    /// Returns an error if there is no such finger, if the finger is not running, if the number of poses, a time or an
    /// angle is outside its range, or if the hand cannot be commanded ([`RemoteHand::send_position`]).
    pub fn send_path(&self, finger: i32, poses: &[PathPose]) -> Result<(), RemoteError> {
        let mut exchange = self.link.shared.lock();
        let changes = exchange.admit_path(finger, poses, now())?;
        exchange.put(changes, None);
        drop(exchange);
        self.link.shared.wake();
        Ok(())
    }

    /// Sends commands to several fingers. All of them take effect in the same cycle. Either every command is sent, or
    /// none is.
    ///
    /// # Errors
    /// Returns the errors of the single calls, and an error if a finger has two commands.
    pub fn send_group(&self, commands: &[FingerCommand]) -> Result<(), RemoteError> {
        let mut exchange = self.link.shared.lock();
        let changes = exchange.admit(commands, now())?;
        exchange.put(changes, None);
        drop(exchange);
        self.link.shared.wake();
        Ok(())
    }
}
