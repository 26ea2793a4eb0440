//! Checks whether a hand can be read and commanded now. State and Status are messages of docs/remote-protocol.md.

use super::Exchange;
use crate::admission::{admit, admit_path, by_finger};
use crate::change::Change;
use crate::command::FingerCommand;
use crate::error::RemoteError;
use crate::progress::RemoteProgress;
use sun2xp_remote_protocol::{FINGERS, Finger, FingerStatus, PathPose, Place, Record, Stage, Status};

const MS: u64 = 1_000_000;

/// Time without a State after which the newest Status counts as too old, ns.
const LONGEST_SILENCE: u64 = 3_000_000_000;

impl Exchange {
    /// The newest record of a finger, if it is not too old.
    pub fn record(&self, number: i32, now: u64) -> Result<&Record, RemoteError> {
        let finger = self.finger(number)?;
        let record = self.view.newest(finger).ok_or_else(|| self.nothing_heard())?;
        // A finger that has stopped may have no new cycles, so the time since the newest State counts.
        let age = match record.stage {
            Stage::Faulted(_) => self.view.silence(now),
            _ => self.view.age(finger, now),
        };
        let age = age.ok_or_else(|| self.nothing_heard())?;
        if age > u64::from(self.stale_ms) * MS {
            let (age_ms, stale_ms, endpoint) = (age / MS, self.stale_ms, self.endpoint.clone());
            return Err(RemoteError::Stale { finger, age_ms, stale_ms, endpoint });
        }
        Ok(record)
    }

    /// The newest record of a finger that has not stopped, if it is not too old.
    pub fn moving(&self, number: i32, now: u64) -> Result<&Record, RemoteError> {
        let record = self.record(number, now)?;
        self.refuse_faulted(record)?;
        Ok(record)
    }

    /// What a finger has done since the newest command. Refuses if no command could be sent to the finger now, or if
    /// its newest record is too old.
    pub fn progress(&mut self, number: i32, now: u64) -> Result<RemoteProgress, RemoteError> {
        let finger = self.finger(number)?;
        self.refuse_unless_ready(now, [finger])?;
        let &Record { arrived, settled, .. } = self.record(number, now)?;
        let applied = self.outbox.is_applied(finger);
        Ok(RemoteProgress { applied, arrived: applied && arrived, settled: applied && settled })
    }

    /// The status of a finger in the newest Status.
    pub fn finger_status(&self, number: i32) -> Result<&FingerStatus, RemoteError> {
        let finger = self.finger(number)?;
        let status = self.view.status().ok_or_else(|| self.nothing_heard())?;
        let of_finger = status.fingers[finger.index()].as_ref();
        of_finger.ok_or_else(|| RemoteError::NotInHand { finger, hand: self.hand.clone() })
    }

    /// Checks commands, and that they can be sent now. Returns the changes.
    pub fn admit(&mut self, commands: &[FingerCommand], now: u64) -> Result<[Option<Change>; FINGERS], RemoteError> {
        let mut numbered = Vec::with_capacity(commands.len());
        for command in commands {
            let finger = self.finger(command.finger)?;
            admit(self.finger_status(command.finger)?, finger, command)?;
            numbered.push((finger, command));
        }
        let changes = by_finger(&numbered)?.map(|command| command.map(Change::of));
        self.refuse_unless_ready(now, numbered.iter().map(|&(finger, _)| finger))?;
        Ok(changes)
    }

    /// Checks a path, and that it can be sent now. Returns the changes.
    pub fn admit_path(
        &mut self,
        number: i32,
        poses: &[PathPose],
        now: u64,
    ) -> Result<[Option<Change>; FINGERS], RemoteError> {
        let finger = self.finger(number)?;
        admit_path(self.finger_status(number)?, finger, poses)?;
        self.refuse_unless_ready(now, [finger])?;
        match self.view.newest(finger).map(|record| record.stage) {
            Some(Stage::Running) => {}
            other => return Err(RemoteError::Busy { finger, stage: other.map_or("in an unknown stage", Stage::name) }),
        }
        let mut changes = [const { None }; FINGERS];
        changes[finger.index()] = Some(Change { place: Place::Path(poses.to_vec()), ..Change::default() });
        Ok(changes)
    }

    /// Refuses to send if this client does not own the hand, if no State was received recently, if a finger has
    /// stopped, or if the hand has refused an earlier set point. The refusal of an earlier set point is reported only
    /// once.
    fn refuse_unless_ready(&mut self, now: u64, fingers: impl IntoIterator<Item = Finger>) -> Result<(), RemoteError> {
        self.owned()?;
        let silence = self.view.silence(now).ok_or_else(|| self.nothing_heard())?;
        if silence > u64::from(self.stale_ms) * MS {
            let (hand, endpoint) = (self.hand.clone(), self.endpoint.clone());
            return Err(RemoteError::Silent { hand, age_ms: silence / MS, stale_ms: self.stale_ms, endpoint });
        }
        for finger in fingers {
            self.view.newest(finger).map_or(Ok(()), |record| self.refuse_faulted(record))?;
        }
        self.outbox.take_refusal().map_or(Ok(()), |text| Err(RemoteError::Refused(text)))
    }

    /// Refuses if this client does not own the hand.
    pub fn owned(&self) -> Result<(), RemoteError> {
        let refused = |loss| RemoteError::NotOwner { hand: self.hand.clone(), loss };
        self.outbox.ownership().map(drop).map_err(refused)
    }

    /// The newest Status, if a State was received within `LONGEST_SILENCE`, or if no State was received yet.
    pub fn status(&self, now: u64) -> Result<&Status, RemoteError> {
        let status = self.view.status().ok_or_else(|| self.nothing_heard())?;
        match self.view.silence(now) {
            Some(silence) if silence > LONGEST_SILENCE => Err(RemoteError::NotConnected(format!(
                "for {:.1} s, nothing was received from the hand \"{}\": check the line to {} and the server",
                silence as f64 * 1e-9,
                self.hand,
                self.endpoint
            ))),
            _ => Ok(status),
        }
    }

    fn refuse_faulted(&self, record: &Record) -> Result<(), RemoteError> {
        let Stage::Faulted(fault) = record.stage else { return Ok(()) };
        let finger = record.finger;
        let status = self.view.status().and_then(|status| status.fingers[finger.index()].as_ref());
        // The Status comes once a second, and may still describe another fault.
        let name = status.filter(|status| status.stage == record.stage).map(|status| status.fault_text.fault());
        Err(RemoteError::Faulted { finger, fault, name: name.unwrap_or_default().into() })
    }

    fn nothing_heard(&self) -> RemoteError {
        RemoteError::NotConnected(format!(
            "nothing was received from the hand \"{}\" yet: check the line to {}, and whether the server permits this \
             client to read",
            self.hand, self.endpoint
        ))
    }
}
