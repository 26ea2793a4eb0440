//! The thread that reads the hand and publishes what it reads. It attaches again when the hand returns.

use super::hub::{Hub, Kind};
use super::message::ToPage;
use super::translation::Translation;
use crate::monitor::source::Wanted;
use std::thread::sleep;
use std::time::Duration;
use sun2xp::telemetry::Reader;

/// Interval of the attempts to attach.
const RETRY: Duration = Duration::from_millis(300);

/// Longest wait for the next batch of the hand.
const WAIT: Duration = Duration::from_millis(200);

/// Reads the hand until the process ends.
pub fn run(wanted: &Wanted, control: bool, hub: &Hub) {
    let mut reported = None;
    loop {
        match wanted.attach().map_err(|error| error.to_string()) {
            Ok(reader) => {
                reported = None;
                let reason = follow(reader, control, hub);
                publish(hub, Kind::Gone, &ToPage::Gone { reason: &reason });
            }
            Err(reason) if reported.as_ref() != Some(&reason) => {
                publish(hub, Kind::Gone, &ToPage::Gone { reason: &reason });
                reported = Some(reason);
            }
            Err(_) => {}
        }
        sleep(RETRY);
    }
}

/// Publishes a message.
pub fn publish(hub: &Hub, kind: Kind, message: &ToPage) {
    // This always succeeds: all keys are texts, and a number that is not finite becomes null.
    if let Ok(text) = serde_json::to_string(message) {
        hub.publish(kind, text);
    }
}

/// Publishes what a hand does. Returns why the hand cannot be read any more.
fn follow(mut reader: Reader, control: bool, hub: &Hub) -> String {
    let mut translation = Translation::new(reader.description(), control, hub);
    let mut messages = Vec::new();
    loop {
        messages.clear();
        if let Err(ended) = reader.read(WAIT, &mut messages) {
            return ended.to_string();
        }
        translation.take(&messages, reader.lost().iter().sum());
    }
}
