//! The servo's part of a finger's events: the detectors, the log, and the threads that wait for events.

use crate::control::events::{Arrival, DetectorState, Detectors};
use crate::control::{Report, SetPoint};
use crate::finger::events::{EventLog, EventWriter, Occurrence, event_log};
use crate::model::FingerNumber;
use crate::realtime::{EventCount, LockedMemory, SharedPages};

/// The servo's part of a finger's events.
pub(super) struct EventOutput {
    writer: EventWriter,
    log: EventLog,
    detectors: DetectorState,
    /// The kinds of the events that have been written since the last call of [`EventOutput::take_kinds`]. Bit n stands
    /// for the kind with number n.
    kinds: u32,
    /// Whether the last cycle has published events.
    published: bool,
    /// The threads that wait for events.
    readers: Option<SharedPages<EventCount>>,
}

impl EventOutput {
    /// Adds the pages of the log to `memory`.
    pub fn new(finger: FingerNumber, initial: SetPoint, memory: &mut LockedMemory) -> Self {
        let (writer, log) = event_log(finger);
        writer.add_to(memory);
        Self { writer, log, detectors: DetectorState::holding(initial), kinds: 0, published: false, readers: None }
    }

    /// Begins a cycle. Later events get its number and its time, ns.
    pub fn begin_cycle(&mut self, cycle: u64, time: u64) {
        self.writer.begin_cycle(cycle, time);
    }

    /// Writes an event of this cycle.
    pub fn write(&mut self, occurrence: Occurrence) {
        self.kinds |= 1 << occurrence.kind.number();
        self.writer.write(occurrence);
    }

    /// Returns the kinds of the events that have been written since the last call. Bit n stands for the kind with
    /// number n.
    pub fn take_kinds(&mut self) -> u32 {
        std::mem::take(&mut self.kinds)
    }

    /// Publishes the events of this cycle. `next` is the scheduled beginning of the next one, ns.
    pub fn publish(&mut self, next: u64) {
        self.published = self.writer.publish(next);
    }

    /// Restarts the detectors when the finger enters the stage `Running` and holds this set point. Returns an
    /// [`Arrival`] which states that the finger has arrived at the set point and has settled.
    pub fn restart_detectors(&mut self, set_point: SetPoint) -> Arrival {
        self.detectors = DetectorState::holding(set_point);
        self.detectors.arrival()
    }

    /// Runs the detectors after a cycle, and writes their observations to the log.
    pub fn observe(&mut self, detectors: &Detectors, report: &Report, set_point: &SetPoint) -> Arrival {
        let observations = detectors.observe(&mut self.detectors, report, set_point);
        observations.iter().for_each(|observation| self.write(observation.into()));
        self.detectors.arrival()
    }

    /// Sets the counter at which threads wait for events.
    pub fn set_readers(&mut self, readers: SharedPages<EventCount>) {
        self.readers = Some(readers);
    }

    /// Wakes a thread that waits for events. Makes one system call if a thread waits, and otherwise none.
    pub fn announce(&self) {
        self.readers.iter().for_each(|readers| readers.notify());
    }

    /// Returns whether the last cycle has published events.
    pub fn published(&self) -> bool {
        self.published
    }

    /// Returns the log.
    pub fn log(&self) -> &EventLog {
        &self.log
    }
}
