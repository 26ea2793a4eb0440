//! Checks of `src/finger/events/log.rs` with one servo and one reader.

use super::log::{EventWriter, event_log_of};
use super::{Event, Occurrence};
use crate::model::FingerNumber;
use crate::spawn;
use std::iter::from_fn;

/// Number of events that the servo writes.
const EVENTS: u64 = 2;

fn write_events(mut writer: EventWriter) -> EventWriter {
    for number in 1..=EVENTS {
        writer.begin_cycle(number, number);
        writer.write(Occurrence { kind: (), part: (), values: () });
        writer.publish(number + 1);
    }
    writer
}

/// A reader of a log that is overwritten gets whole events in order, and counts those that it has lost.
pub fn events_are_whole_and_lost_events_are_counted() {
    let (writer, log) = event_log_of(FingerNumber::ONE, 1);
    let mut reader = log.reader();
    let servo = spawn(move || write_events(writer));
    let mut arrived: Vec<Event> = reader.take().into_iter().collect();
    let _writer = servo.join().expect("no panic");
    arrived.extend(from_fn(|| reader.take()));
    for event in &arrived {
        assert_eq!(event.cycle, event.time, "parts of different events");
    }
    assert!(arrived.is_sorted_by(|before, after| before.cycle < after.cycle), "{arrived:?}");
    assert_eq!(arrived.len() as u64 + reader.lost(), EVENTS, "{arrived:?} arrived");
}

/// After a reader has read the horizon and then taken all events, it receives no event that is earlier than the
/// horizon.
pub fn no_later_event_is_before_the_horizon() {
    let (writer, log) = event_log_of(FingerNumber::ONE, EVENTS as usize);
    let mut reader = log.reader();
    let servo = spawn(move || write_events(writer));
    let horizon = reader.horizon();
    while reader.take().is_some() {}
    let _writer = servo.join().expect("no panic");
    let later: Vec<Event> = from_fn(|| reader.take()).collect();
    assert!(later.iter().all(|event| event.time >= horizon), "events before the horizon {horizon}: {later:?}");
}
