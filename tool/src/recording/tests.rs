//! Recordings of a simulated hand are read again, complete or not, and so are black boxes.

use super::channels::FORMAT;
use super::{Entry, Item, Recording, RecordingWriter};
use mcap::records::Metadata;
use mcap::write::WriteOptions;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, UNIX_EPOCH};
use sun2xp::hand::Hand;
use sun2xp::model::FingerNumber;
use sun2xp::model::configuration::Configuration;
use sun2xp::realtime::{clock_offset, now};
use sun2xp::telemetry::{Message, Reader};
use tempfile::TempDir;

fn open(name: &str) -> Hand {
    let mut configuration = Configuration::default();
    configuration.telemetry.name = format!("recording-{}-{name}", std::process::id());
    Hand::open(configuration).unwrap_or_else(|error| panic!("open: {error}"))
}

/// Reads from a simulated hand for this time. Returns the messages, and the reader, which has the description of the
/// hand.
fn messages(name: &str, time: Duration) -> (Reader, Vec<Message>) {
    let hand = open(name);
    let mut reader = Reader::attach(Some(&format!("recording-{}-{name}", std::process::id()))).expect("attached");
    hand.send_position(1, [0.1, 0.5, 0.9]).expect("sent");
    let (mut messages, end) = (Vec::new(), Instant::now() + time);
    while Instant::now() < end {
        reader.read(Duration::from_millis(100), &mut messages).expect("open");
    }
    hand.stop(2).expect("stopped");
    drop(hand);
    while reader.read(Duration::from_millis(100), &mut messages).is_ok() {}
    (reader, messages)
}

fn write(path: &Path, reader: &Reader, messages: &[Message]) {
    let file = File::create(path).expect("a file");
    let mut writer = RecordingWriter::new(file, reader.description(), now()).expect("begun");
    for (number, message) in messages.iter().enumerate() {
        writer.write(message).expect("written");
        if number % 500 == 0 {
            writer.write_lost(FingerNumber::THREE, 7).expect("written");
            std::thread::sleep(Duration::from_millis(1));
            writer.flush_if_due().expect("written");
        }
    }
    writer.finish().expect("finished");
}

/// Records a hand for this time. Returns the folder of the file, its path and its bytes.
fn recorded(name: &str, time: Duration) -> (TempDir, PathBuf, Vec<u8>) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("hand.mcap");
    let (reader, messages) = messages(name, time);
    write(&path, &reader, &messages);
    let whole = fs::read(&path).expect("the file");
    (folder, path, whole)
}

/// The messages in a form that can be compared. The status is recorded without its last cycle.
fn shown<'a>(messages: impl IntoIterator<Item = &'a Message>) -> Vec<String> {
    let shown = |message: &Message| match message {
        Message::Status(status) => {
            let mut status = status.clone();
            status.last = None;
            format!("{status:?}")
        }
        message => format!("{message:?}"),
    };
    messages.into_iter().map(shown).collect()
}

#[test]
fn a_recording_has_every_message_with_every_bit() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("hand.mcap");
    let (reader, messages) = messages("whole", Duration::from_millis(700));
    write(&path, &reader, &messages);
    let mut recording = Recording::open(&path).expect("a recording");
    assert_eq!(recording.description(), reader.description());
    let entries: Vec<Entry> = recording.by_ref().map(|entry| entry.expect("readable")).collect();
    assert!(recording.is_complete() && recording.progress() > 0.9);
    let lost = entries.iter().filter(|entry| matches!(entry.item, Item::Lost { cycles: 7, .. })).count();
    assert_eq!(lost, messages.len().div_ceil(500));
    let recorded = entries.iter().filter_map(|entry| match &entry.item {
        Item::Message(message) => Some(message),
        Item::Lost { .. } => None,
    });
    assert_eq!(shown(recorded), shown(&messages));
    let offset = reader.description().clock_offset;
    for entry in &entries {
        if let Item::Message(Message::Cycle { record, .. }) = &entry.item {
            assert_eq!(entry.time, record.began.saturating_add_signed(offset));
        }
    }
    let kinds = |find: fn(&Message) -> bool| messages.iter().filter(|message| find(message)).count();
    assert!(kinds(|message| matches!(message, Message::Cycle { .. })) > 1500);
    assert!(kinds(|message| matches!(message, Message::Event(_))) > 0);
    assert!(kinds(|message| matches!(message, Message::Status(_))) > 2);
}

#[test]
fn a_recording_in_another_version_of_the_format_is_refused_with_the_library_to_use() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("hand.mcap");
    let mut writer = WriteOptions::new().create(File::create(&path).expect("a file")).expect("begun");
    let metadata = [("version", "0"), ("library", "0.0.9")].map(|(key, value)| (key.to_owned(), value.to_owned()));
    writer.write_metadata(&Metadata { name: FORMAT.into(), metadata: metadata.into() }).expect("written");
    writer.finish().expect("finished");
    let refusal = Recording::open(&path).err().expect("another version").to_string();
    let remedy = "use the sun2xp program of version 0.0.9, which wrote the file";
    assert!(refusal.contains("has format version 0,") && refusal.ends_with(remedy), "{refusal}");
}

/// The usual error says what the author of a configuration file must write. A person who opens a recording is not this
/// author, so the error says that the file was altered.
#[test]
fn altered_configurations_are_refused_without_the_remedy_for_their_authors() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("hand.mcap");
    let (reader, mut messages) = messages("altered", Duration::from_millis(200));
    let mut description = reader.description().clone();
    description.configuration.fingers[1].motor.sign[3] = 0;
    let writer = RecordingWriter::new(File::create(&path).expect("a file"), &description, now()).expect("begun");
    writer.finish().expect("finished");
    let refusal = Recording::open(&path).err().expect("altered").to_string();
    let reason = "motor.sign: [1, 1, 1, 0] has an entry other than 1 and -1. The file was altered";
    assert!(refusal.contains(&format!("cannot be used: finger.2.{reason}")), "{refusal}");
    for message in &mut messages {
        if let Message::Controller { source, .. } = message {
            source.finger.motor.sign[3] = 0;
        }
    }
    write(&path, &reader, &messages);
    let refusal = Recording::open(&path).expect("a recording").find_map(Result::err).expect("altered").to_string();
    assert!(
        refusal.contains(&format!("/finger1/replay describes a controller that cannot be used: {reason}")),
        "{refusal}"
    );
}

#[test]
fn a_recording_that_is_cut_between_two_records_is_incomplete() {
    let (_folder, path, whole) = recorded("between", Duration::from_millis(200));
    let mut readable = 0;
    for end in ends_of_records(&whole) {
        fs::write(&path, &whole[..end]).expect("written");
        let Ok(mut recording) = Recording::open(&path) else { continue };
        for entry in recording.by_ref() {
            entry.expect("readable");
        }
        assert!(!recording.is_complete(), "{end} of {} bytes", whole.len());
        readable += 1;
    }
    assert!(readable > 5);
}

/// Returns the place after each record up to the footer. The record of the footer itself is not among them.
fn ends_of_records(file: &[u8]) -> Vec<usize> {
    // After 8 bytes that name the format, each record has a byte for its kind and 8 for its length.
    let (mut end, mut ends) = (8, Vec::new());
    while file[end] != mcap::records::op::FOOTER {
        let length = u64::from_le_bytes(file[end + 1..end + 9].try_into().expect("8 bytes"));
        end += 9 + usize::try_from(length).expect("a length");
        ends.push(end);
    }
    ends
}

#[test]
fn a_recording_that_is_cut_anywhere_is_readable_up_to_its_last_whole_chunk() {
    let (_folder, path, whole) = recorded("cut", Duration::from_millis(400));
    let mut read = Vec::new();
    for part in [30, 60, 90, 99] {
        fs::write(&path, &whole[..whole.len() * part / 100]).expect("written");
        let mut recording = Recording::open(&path).expect("a recording");
        let mut count = 0;
        for entry in recording.by_ref() {
            entry.expect("readable");
            count += 1;
        }
        assert!(!recording.is_complete() || part == 99);
        read.push(count);
    }
    assert!(read.is_sorted() && *read.last().expect("parts") > 300, "{read:?}");
}

#[test]
fn no_altered_byte_makes_entries_disappear_from_a_complete_recording() {
    let (_folder, path, whole) = recorded("kinds", Duration::from_millis(400));
    let written = Recording::open(&path).expect("a recording").count();
    let ends = ends_of_records(&whole);
    // The byte after the end of a record is the kind of the next one.
    let places = (0..whole.len()).step_by(whole.len() / 300).chain(ends);
    let mut refused = 0;
    for place in places {
        let mut altered = whole.clone();
        altered[place] ^= 0x55;
        fs::write(&path, &altered).expect("written");
        let Ok(mut recording) = Recording::open(&path) else { continue };
        let read: Vec<_> = recording.by_ref().collect();
        let error = read.last().and_then(|last| last.as_ref().err()).map(ToString::to_string);
        assert!(error.is_some() || !recording.is_complete() || read.len() == written, "byte {place}");
        refused += u32::from(error.is_some_and(|text| text.contains("were written. The file was altered")));
    }
    assert!(refused > 0, "no chunk was lost");
}

/// Waits until finger 2 has run 200 more cycles.
fn run(hand: &Hand) {
    let begun = hand.losses(2).expect("losses").cycles;
    while hand.losses(2).expect("losses").cycles < begun + 200 {
        std::thread::sleep(Duration::from_millis(5));
    }
}

#[test]
fn the_times_of_a_black_box_do_not_depend_on_the_time_of_its_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("black-box.jsonl");
    let hand = open("times");
    run(&hand);
    hand.write_black_box(2, &path).expect("written");
    drop(hand);
    let offset = |copy: &str| {
        fs::write(&path, copy).expect("written");
        let file = File::options().write(true).open(&path).expect("a file");
        file.set_modified(UNIX_EPOCH).expect("set");
        Recording::open(&path).expect("a recording").description().clock_offset
    };
    let text = fs::read_to_string(&path).expect("text");
    let error = offset(&text).abs_diff(clock_offset());
    assert!(error < 1_000_000_000, "{error} ns");
    // A file of an older library contains only the time at which it was written, in whole seconds.
    let (before, after) = text.split_once("\"clock_offset\":").expect("the key");
    let (_, after) = after.split_once(',').expect("the next key");
    let error = offset(&format!("{before}{after}")).abs_diff(clock_offset());
    assert!(error < 5_000_000_000, "{error} ns");
}

#[test]
fn a_black_box_is_a_recording() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("black-box.jsonl");
    let hand = open("box");
    run(&hand);
    hand.stop(2).expect("stopped");
    while hand.status(2).expect("status").stage == sun2xp::Stage::Running {
        std::thread::sleep(Duration::from_millis(5));
    }
    hand.write_black_box(2, &path).expect("written");
    drop(hand);
    let black_box = sun2xp::Recording::open(&path).expect("a black box");
    let recording = Recording::open(&path).expect("a recording");
    assert_eq!(recording.description().fingers, [FingerNumber::TWO]);
    let mut cycles = Vec::new();
    for entry in recording {
        if let Item::Message(Message::Cycle { record, .. }) = entry.expect("readable").item {
            cycles.push((record.cycle, record.stage.to_string(), record.control));
        }
    }
    let expected: Vec<_> = black_box.cycles.iter().map(|c| (c.cycle, c.stage.clone(), c.control)).collect();
    assert!(cycles.len() > 100, "{} cycles", cycles.len());
    assert!(cycles == expected);
    assert!(cycles.last().expect("cycles").1.starts_with("faulted: "));
}

#[test]
fn other_files_are_refused_with_a_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("other");
    for (content, words) in [("", "description"), ("text", "not a recording"), ("{}", "black box")] {
        fs::write(&path, content).expect("written");
        let error = Recording::open(&path).err().expect("refused").to_string();
        assert!(error.contains(words), "{content:?}: {error}");
    }
    let error = Recording::open(&folder.path().join("missing")).err().expect("refused").to_string();
    assert!(error.starts_with("cannot read") && error.ends_with(". Name an existing file"), "{error}");
}
