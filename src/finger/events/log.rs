//! The log of a finger's events: a ring that its servo overwrites, and that any number of readers reads.
//!
//! The servo neither waits for a reader nor knows of one. A reader that falls behind loses the oldest events, and
//! counts them. Each place has a sequence number, which the servo clears before it overwrites the place. A reader
//! therefore detects that a place has changed while the reader copied it.

use super::words::WORDS;
use super::{Event, Occurrence};
use crate::model::FingerNumber;
use crate::realtime::atomics::{AtomicU64, Ordering, fence};
use crate::realtime::{LockedMemory, Pages, SharedPages};

/// Number of events that the log holds.
pub const CAPACITY: usize = 4096;

/// Sequence number of a place that the servo is overwriting, or that has no event yet.
const NO_EVENT: u64 = 0;

/// A log. Clones are the same log.
#[derive(Clone)]
pub struct EventLog(SharedPages<Log>);

/// The servo's end. It never waits or allocates.
pub struct EventWriter {
    log: SharedPages<Log>,
    finger: FingerNumber,
    /// Number of events written since open.
    written: u64,
    /// Number of events that readers can see.
    published: u64,
    cycle: u64,
    time: u64,
}

/// A reader's end. Each reader gets every event that is still in the log when it reads.
pub struct EventReader {
    log: SharedPages<Log>,
    /// Number of events that were written before the one that this reader takes next.
    position: u64,
    lost: u64,
}

struct Log {
    /// Number of events that readers can see.
    published: AtomicU64,
    /// All events that are published later have this time or a later one, ns.
    horizon: AtomicU64,
    places: Pages<[Place]>,
}

/// An event in a cache line of its own.
#[repr(align(64))]
struct Place {
    /// Number of the event in the order of writing, counted from 1, or [`NO_EVENT`].
    sequence: AtomicU64,
    words: [AtomicU64; WORDS],
}

impl Log {
    fn capacity(&self) -> u64 {
        self.places.len() as u64
    }

    fn place(&self, position: u64) -> &Place {
        &self.places[(position % self.capacity()) as usize]
    }
}

/// Returns an empty log and its servo's end.
pub fn event_log(finger: FingerNumber) -> (EventWriter, EventLog) {
    event_log_of(finger, CAPACITY)
}

/// Returns an empty log for `capacity` events, and its servo's end.
pub(super) fn event_log_of(finger: FingerNumber, capacity: usize) -> (EventWriter, EventLog) {
    let places = Pages::from_fn(capacity, |_| Place {
        sequence: AtomicU64::new(NO_EVENT),
        words: std::array::from_fn(|_| AtomicU64::new(0)),
    });
    let log = Log { published: AtomicU64::new(0), horizon: AtomicU64::new(0), places };
    let log = SharedPages::from(Pages::new(log));
    let writer = EventWriter { log: log.clone(), finger, written: 0, published: 0, cycle: 0, time: 0 };
    (writer, EventLog(log))
}

impl EventLog {
    /// Returns a reader that begins with the oldest event in the log. Earlier events do not count as lost.
    pub fn reader(&self) -> EventReader {
        let published = self.0.published.load(Ordering::Acquire);
        EventReader { log: self.0.clone(), position: published.saturating_sub(self.0.capacity()), lost: 0 }
    }
}

impl EventWriter {
    /// Begins a cycle. Later events get its number and its time, ns.
    pub fn begin_cycle(&mut self, cycle: u64, time: u64) {
        (self.cycle, self.time) = (cycle, time);
    }

    /// Writes an event of this cycle. It overwrites the oldest event if the log is full. Readers see the event after
    /// [`EventWriter::publish`].
    pub fn write(&mut self, occurrence: Occurrence) {
        let Occurrence { kind, part, values } = occurrence;
        let event = Event { finger: self.finger, cycle: self.cycle, time: self.time, kind, part, values };
        let place = self.log.place(self.written);
        place.sequence.store(NO_EVENT, Ordering::Relaxed);
        // A reader that sees one of the new words also sees that the place has changed.
        fence(Ordering::Release);
        for (place, word) in place.words.iter().zip(event.to_words()) {
            place.store(word, Ordering::Relaxed);
        }
        self.written += 1;
        place.sequence.store(self.written, Ordering::Release);
    }

    /// Publishes the events of this cycle. All events that are published later must have the time `horizon`, ns, or a
    /// later one. Returns whether there were any events.
    pub fn publish(&mut self, horizon: u64) -> bool {
        let any = self.written != self.published;
        if any {
            self.log.published.store(self.written, Ordering::Release);
            self.published = self.written;
        }
        self.log.horizon.store(horizon, Ordering::Release);
        any
    }

    /// Adds the log's pages to `memory`.
    pub fn add_to(&self, memory: &mut LockedMemory) {
        memory.add_shared(&self.log);
        memory.add(&self.log.places);
    }
}

impl Drop for EventWriter {
    fn drop(&mut self) {
        // There are no later events.
        self.log.horizon.store(u64::MAX, Ordering::Release);
    }
}

impl EventReader {
    /// Takes the oldest event that this reader has not taken and that the log still holds. Returns none if there is no
    /// such event.
    pub fn take(&mut self) -> Option<Event> {
        let published = self.log.published.load(Ordering::Acquire);
        let oldest = published.saturating_sub(self.log.capacity());
        if self.position < oldest {
            self.lost += oldest - self.position;
            self.position = oldest;
        }
        while self.position < published {
            let event = self.read(self.position);
            self.position += 1;
            match event {
                Some(event) => return Some(event),
                // The servo has overwritten the place since `published` was read.
                None => self.lost += 1,
            }
        }
        None
    }

    /// Returns the number of events that this reader has lost because it was too slow.
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// Returns the horizon, ns: all events that are published later have this time or a later one. So call this
    /// function first, and then [`EventReader::take`] until it returns none. All events that this reader takes
    /// afterwards have the time of the horizon or a later one.
    pub fn horizon(&self) -> u64 {
        self.log.horizon.load(Ordering::Acquire)
    }

    /// Skips all events that are in the log.
    pub fn skip(&mut self) {
        self.position = self.log.published.load(Ordering::Acquire);
    }

    fn read(&self, position: u64) -> Option<Event> {
        let place = self.log.place(position);
        let sequence = place.sequence.load(Ordering::Acquire);
        if sequence != position + 1 {
            return None;
        }
        let words = std::array::from_fn(|index| place.words[index].load(Ordering::Relaxed));
        fence(Ordering::Acquire);
        if place.sequence.load(Ordering::Relaxed) != sequence {
            return None;
        }
        Event::from_words(&words)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::finger::events::EventKind;
    use crate::model::Part;
    use std::thread;

    fn occurrence(number: u64) -> Occurrence {
        Occurrence { kind: EventKind::Contact, part: Part::Finger, values: [number as f64; 4] }
    }

    #[test]
    fn readers_see_the_events_of_published_cycles_with_their_stamps() {
        let (mut writer, log) = event_log(FingerNumber::TWO);
        let (mut first, mut second) = (log.reader(), log.reader());
        writer.begin_cycle(7, 1000);
        writer.write(occurrence(1));
        writer.write(occurrence(2));
        assert_eq!(first.take(), None);
        assert!(writer.publish(2000));
        assert!(!writer.publish(3000));
        for reader in [&mut first, &mut second] {
            assert_eq!(reader.horizon(), 3000);
            for number in [1.0, 2.0] {
                let event = reader.take().expect("published");
                assert_eq!((event.finger, event.cycle, event.time), (FingerNumber::TWO, 7, 1000));
                assert_eq!((event.kind, event.values), (EventKind::Contact, [number; 4]));
            }
            assert_eq!((reader.take(), reader.lost()), (None, 0));
        }
        drop(writer);
        assert_eq!(first.horizon(), u64::MAX);
    }

    #[test]
    fn a_full_log_loses_the_oldest_events_and_counts_them() {
        let (mut writer, log) = event_log(FingerNumber::ONE);
        let mut reader = log.reader();
        let excess = 10;
        for number in 0..CAPACITY as u64 + excess {
            writer.write(occurrence(number));
        }
        writer.publish(0);
        assert_eq!(reader.take().map(|event| event.values[0]), Some(excess as f64));
        // These events overwrite places that the reader still has to read, and are not published yet.
        for number in 0..5 {
            writer.write(occurrence(number));
        }
        assert_eq!(reader.take().map(|event| event.values[0]), Some(excess as f64 + 5.0));
        assert_eq!(reader.lost(), excess + 4);
        assert_eq!(log.reader().take().map(|event| event.values[0]), Some(excess as f64 + 5.0));
        reader.skip();
        assert_eq!(reader.take(), None);
    }

    #[test]
    fn no_event_is_torn_and_every_event_arrives_or_is_counted() {
        const LAST: u64 = 400_000;
        let (mut writer, log) = event_log(FingerNumber::THREE);
        let mut reader = log.reader();
        let servo = thread::spawn(move || {
            for number in 1..=LAST {
                writer.begin_cycle(number, number);
                writer.write(occurrence(number));
                writer.publish(number);
                if number % 1000 == 0 {
                    thread::yield_now();
                }
            }
        });
        let (mut last, mut arrived) = (0, 0);
        while last < LAST {
            let Some(event) = reader.take() else {
                thread::yield_now();
                continue;
            };
            assert!(event.cycle > last && event.time == event.cycle, "{event:?} after {last}");
            assert_eq!(event.values, [event.cycle as f64; 4]);
            (last, arrived) = (event.cycle, arrived + 1);
        }
        servo.join().expect("no panic");
        assert_eq!(arrived + reader.lost(), LAST);
    }
}
