//! The files of a recording, without a hand.

use super::*;
use crate::recording::{Item, Recording};
use sun2xp::finger::{CycleRecord, Stage};
use sun2xp::model::configuration::Configuration;
use tempfile::TempDir;

/// With these limits, every call of [`Files::turn`] begins a new file.
const AT_ONCE: Limits = Limits { bytes: Some(0), age: None, keep: Some(2) };

fn description() -> Description {
    Description {
        name: "hand".into(),
        process: 1,
        library: "test".into(),
        started: 1,
        clock_offset: 1_000_000_000_000,
        fingers: vec![FingerNumber::ONE],
        configuration: Configuration::default(),
    }
}

fn begin(folder: &TempDir) -> Files {
    Files::begin(Some(folder.path().join("hand.mcap")), &description(), AT_ONCE, 7_000).expect("begun")
}

fn names(folder: &TempDir) -> Vec<String> {
    let entries = fs::read_dir(folder.path()).expect("a folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().into_string().expect("UTF-8")).collect();
    names.sort();
    names
}

/// For each entry of a file: whether it marks lost cycles, and its time, ns of the monotonic clock.
fn times(folder: &TempDir, name: &str) -> Vec<(bool, u64)> {
    let recording = Recording::open(&folder.path().join(name)).expect("a recording");
    let entries = recording.map(|entry| entry.expect("an entry"));
    entries.map(|entry| (matches!(entry.item, Item::Lost { .. }), entry.time - 1_000_000_000_000)).collect()
}

#[test]
fn files_of_an_earlier_recording_are_kept_and_their_numbers_skipped() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("hand-2.mcap"), "old").expect("written");
    fs::write(folder.path().join("hand-4.mcap"), "old").expect("written");
    let mut files = begin(&folder);
    for _ in 0..3 {
        assert!(files.turn().expect("a file").begun);
    }
    assert_eq!(names(&folder), ["hand-2.mcap", "hand-4.mcap", "hand-5.mcap", "hand-6.mcap"]);
    let written = files.finish().expect("finished").to_string();
    assert!(written.contains("hand-6.mcap, the last of 4 files, together "), "{written}");
}

#[test]
fn an_old_file_that_cannot_be_deleted_does_not_end_the_recording() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut files = begin(&folder);
    fs::remove_file(folder.path().join("hand.mcap")).expect("removed");
    for _ in 0..2 {
        let turn = files.turn().expect("a file");
        assert_eq!((turn.begun, turn.undeleted), (true, None), "somebody has moved it");
    }
    // A folder cannot be deleted as a file.
    fs::remove_file(folder.path().join("hand-2.mcap")).expect("removed");
    fs::create_dir(folder.path().join("hand-2.mcap")).expect("made");
    let turn = files.turn().expect("a file");
    assert!(turn.begun && turn.undeleted.is_some_and(|reason| reason.contains("hand-2.mcap")));
}

#[test]
fn a_file_that_cannot_be_deleted_at_first_is_deleted_later() {
    let folder = tempfile::tempdir().expect("a folder");
    let first = folder.path().join("hand.mcap");
    let mut files = begin(&folder);
    fs::remove_file(&first).expect("removed");
    fs::create_dir(&first).expect("made");
    let undeleted: Vec<bool> = (0..3).map(|_| files.turn().expect("a file").undeleted.is_some()).collect();
    assert_eq!(undeleted, [false, true, false], "reported once");
    assert_eq!(names(&folder), ["hand-3.mcap", "hand-4.mcap", "hand.mcap"], "the other files are deleted");
    fs::remove_dir(&first).expect("removed");
    fs::write(&first, "can be deleted now").expect("written");
    files.turn().expect("a file");
    assert_eq!(names(&folder), ["hand-4.mcap", "hand-5.mcap"]);
}

#[test]
fn a_file_that_cannot_be_written_or_deleted_is_named_with_the_cause_and_the_remedy() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("hand.mcap");
    let full = OpenOptions::new().write(true).open("/dev/full").expect("a full disk");
    let failure = OpenFile::begin(path.clone(), full, &description(), 0).err().expect("a full disk").to_string();
    assert!(failure.starts_with("cannot write ") && failure.contains("No space left on device"), "{failure}");
    let denied = io::Error::from(ErrorKind::PermissionDenied);
    let remedy = ": permission denied. Give this user permission to write the file and its folder";
    let failure = unwritten(&path, &denied).to_string();
    assert!(failure.starts_with("cannot write ") && failure.ends_with(remedy), "{failure}");
    let failure = unwritten(&path, &io::Error::from(ErrorKind::ReadOnlyFilesystem)).to_string();
    assert!(failure.ends_with(". Make the file system writable, or choose a folder on another one"), "{failure}");
    let message = undeleted(&path, &denied);
    assert!(message.contains(&format!("{remedy}. The file stays")), "{message}");
}

#[test]
fn marks_before_the_first_cycle_of_a_file_have_the_time_of_the_cycle_before() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut files = begin(&folder);
    files.write_lost(FingerNumber::ONE, 1).expect("written");
    let record = CycleRecord {
        cycle: 1,
        began: 9_000,
        stage: Stage::Limp,
        timing: Default::default(),
        feedback: None,
        status: 0,
        control: None,
    };
    files.write(&Message::Cycle { finger: FingerNumber::ONE, record }).expect("written");
    files.turn().expect("a file");
    files.write_lost(FingerNumber::ONE, 1).expect("written");
    files.finish().expect("finished");
    assert_eq!(times(&folder, "hand.mcap"), [(true, 7_000), (false, 9_000)]);
    assert_eq!(times(&folder, "hand-2.mcap"), [(true, 9_000)]);
}

#[test]
fn the_number_of_a_file_precedes_its_extension() {
    assert_eq!(numbered(Path::new("a/hand.mcap"), 2), Path::new("a/hand-2.mcap"));
    assert_eq!(numbered(Path::new("hand"), 11), Path::new("hand-11"));
}

#[test]
fn a_name_has_date_and_time() {
    let name = date_and_time();
    let (date, time) = name.split_once('-').expect("two parts");
    assert!((date.len(), time.len()) == (8, 6) && name.bytes().filter(u8::is_ascii_digit).count() == 14, "{name}");
}
