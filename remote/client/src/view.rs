//! What a client knows of a hand. A [`View`] has no clock and no thread.

use crate::server_clock::ServerClock;
use sun2xp_remote_protocol::{DecodeError, FINGERS, Finger, Record, State, Status};

/// What a client has received and sent since it opened the hand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct RemoteStatistics {
    /// States that were received.
    pub states: u64,
    /// States that were lost on the way.
    pub lost_states: u64,
    /// Cycles of which the server has sent no record, because the server was late or one of their values was not
    /// finite.
    pub missing_cycles: u64,
    /// Messages that are not of this version of the protocol, or malformed.
    pub malformed: u64,
    /// Targets that were sent.
    pub targets: u64,
    /// Targets that the hand has refused.
    pub refused: u64,
}

/// What a client knows of a hand.
#[derive(Debug, Default)]
pub struct View {
    clock: ServerClock,
    newest: [Option<Record>; FINGERS],
    /// The newest Status.
    status: Option<Status>,
    /// The time at which the newest State was received, ns.
    received: Option<u64>,
    /// The number and the time of the newest State.
    newest_state: Option<(u64, u64)>,
    /// The error of the newest message that could not be decoded.
    malformed: Option<DecodeError>,
    pub statistics: RemoteStatistics,
}

impl View {
    /// Takes a State. Returns false if it comes from a server that was started again.
    pub fn take_state(&mut self, state: &State, now: u64) -> bool {
        let continued = self.newest_state.is_none_or(|(number, time)| state.number > number && state.time > time);
        if !continued {
            (self.clock, self.newest, self.newest_state) = (ServerClock::default(), [None; FINGERS], None);
        }
        let lost = self.newest_state.map_or(0, |(number, _)| state.number - number - 1);
        self.newest_state = Some((state.number, state.time));
        self.statistics.states += 1;
        let statistics = &mut self.statistics;
        statistics.lost_states = statistics.lost_states.saturating_add(lost);
        statistics.missing_cycles += u64::from(state.missing);
        self.clock.received(state.time, now);
        self.received = Some(now);
        for record in &state.records {
            self.newest[record.finger.index()] = Some(*record);
        }
        continued
    }

    /// Notes a message that cannot be decoded, and is dropped.
    pub fn drop_malformed(&mut self, error: DecodeError) {
        self.statistics.malformed += 1;
        self.malformed = Some(error);
    }

    /// The error of the newest message that could not be decoded.
    pub fn malformed(&self) -> Option<&DecodeError> {
        self.malformed.as_ref()
    }

    pub fn take_status(&mut self, status: Status) {
        self.status = Some(status);
    }

    pub fn status(&self) -> Option<&Status> {
        self.status.as_ref()
    }

    /// The newest record of a finger.
    pub fn newest(&self, finger: Finger) -> Option<&Record> {
        self.newest[finger.index()].as_ref()
    }

    /// The age of the newest record of a finger, ns. It includes the time since its reception, and the part of its
    /// delay on the way that exceeds the smallest delay.
    pub fn age(&self, finger: Finger, now: u64) -> Option<u64> {
        self.clock.age(self.newest(finger)?.begin, now)
    }

    /// Whether a State was published after this time of the server, ns.
    pub fn is_newer_than(&self, time: u64) -> bool {
        self.newest_state.is_some_and(|(_, published)| published > time)
    }

    /// The time since the newest State, ns.
    pub fn silence(&self, now: u64) -> Option<u64> {
        self.received.map(|received| now.saturating_sub(received))
    }
}
