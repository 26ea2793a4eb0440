//! Tests that the items of a recording of a simulated hand contain every cycle, gap and event, and marks of stages.

use super::{Item, Mark, MarkKind, Row, first_cycle, read};
use crate::recording::RecordingWriter;
use std::fs::File;
use std::path::Path;
use std::time::{Duration, Instant};
use sun2xp::hand::Hand;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::{Configuration, RealTime};
use sun2xp::telemetry::{Message, Reader, Sample, View};

/// The messages of a hand whose finger 1 moves, until an event has arrived.
fn messages() -> (Reader, Vec<Message>) {
    let mut configuration = Configuration::default();
    configuration.telemetry.name = format!("trace-{}", std::process::id());
    (configuration.hand.real_time, configuration.hand.rate) = (RealTime::Ignore, 500.0);
    let name = configuration.telemetry.name.clone();
    let hand = Hand::open(configuration).unwrap_or_else(|error| panic!("open: {error}"));
    let mut reader = Reader::attach(Some(&name)).expect("attached");
    hand.send_position(1, [0.1, 0.5, 0.9]).expect("sent");
    let (mut messages, begun) = (Vec::new(), Instant::now());
    while !messages.iter().any(|message| matches!(message, Message::Event(_))) {
        assert!(begun.elapsed() < Duration::from_secs(20), "the finger neither arrives nor settles");
        reader.read(Duration::from_millis(100), &mut messages).expect("open");
    }
    (reader, messages)
}

fn items(path: &Path) -> Vec<Item> {
    let mut items = Vec::new();
    read(path, "test", &mut |item| {
        items.push(item);
        Ok(())
    })
    .expect("a recording");
    items
}

#[test]
fn every_cycle_of_a_recording_is_a_row_and_lost_cycles_are_marked() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("hand.mcap");
    let (reader, messages) = messages();
    let mut writer =
        RecordingWriter::new(File::create(&path).expect("a file"), reader.description(), 0).expect("begun");
    // The recorder may mark cycles that were lost before the first recorded cycle. The mark then has the time at which
    // the recording begins, here 0.
    writer.write_lost(FingerNumber::THREE, 1).expect("written");
    let half = messages.len() / 2;
    messages[..half].iter().for_each(|message| writer.write(message).expect("written"));
    writer.write_lost(FingerNumber::TWO, 12).expect("written");
    messages[half..].iter().for_each(|message| writer.write(message).expect("written"));
    writer.finish().expect("finished");

    let items = items(&path);
    let mut view = View::new(&reader.description().configuration);
    let samples: Vec<Sample> = messages.iter().filter_map(|message| view.take(message)).collect();
    let rows: Vec<&Row> =
        items.iter().filter_map(|item| if let Item::Cycle(row) = item { Some(&**row) } else { None }).collect();
    assert!(samples.len() > 100);
    assert_eq!(rows.iter().map(|row| &row.sample).collect::<Vec<_>>(), samples.iter().collect::<Vec<_>>());
    let fingers = items.iter().filter(|item| matches!(item, Item::Finger(finger) if finger.rate == 500.0));
    assert_eq!(fingers.count(), 3);

    let marks: Vec<&Mark> =
        items.iter().filter_map(|item| if let Item::Mark(mark) = item { Some(mark) } else { None }).collect();
    let of = |kind| marks.iter().filter(move |mark| mark.kind == kind);
    let early = of(MarkKind::Gap).next().expect("a gap");
    assert_eq!((early.finger, early.time), (Some(3), 0));
    let first = rows.iter().map(|row| row.sample.began).next();
    assert!(first.is_some_and(|began| began > 0) && first_cycle(&path).expect("a recording") == first);
    let gap = of(MarkKind::Gap).nth(1).expect("a gap");
    assert_eq!((gap.finger, gap.text.as_str()), (Some(2), "12 cycles are not recorded"));
    // The file has the time of day of the gap. The mark has a time of the monotonic clock, near those of the cycles.
    let nearest = rows.iter().map(|row| row.sample.began.abs_diff(gap.time)).min().expect("a row");
    assert!(nearest < 1_000_000_000, "{nearest} ns");
    let events = messages.iter().filter(|message| matches!(message, Message::Event(_))).count();
    assert_eq!(of(MarkKind::Event).count(), events);
    assert!(of(MarkKind::Event).any(|mark| mark.text.contains("angles of joints 0, 1, 2, rad: ")), "{marks:?}");
    assert!(of(MarkKind::Stage).any(|mark| mark.text == "running" && mark.finger == Some(3)), "{marks:?}");
}
