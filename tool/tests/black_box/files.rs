//! Black box files: an altered bit is found, a damaged file is refused, and numbers keep every bit.

use crate::rig::{eventful, own_board, replayed, replayed_with, turn};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use sun2xp::finger::{CycleRecord, Recording, RecordingError};
use sun2xp::hand::Hand;
use sun2xp::model::configuration::{Configuration, Scheme};

#[test]
fn one_bit_of_feedback_is_found_where_it_was_changed() {
    let _turn = turn();
    let (board, hand) = own_board(Scheme::StateFeedback, None);
    eventful(&board, &hand);
    let recording = hand.recording(2).expect("a recording");
    assert_eq!(recording.replay().expect("replayable").different, 0);
    let place = recording.cycles.iter().rposition(|cycle| cycle.feedback.is_some()).expect("a reply") - 100;
    let place = (place..).find(|&place| recording.cycles[place].feedback.is_some()).expect("a reply");
    for motor in 0..4 {
        for encoder in [true, false] {
            let mut altered = recording.clone();
            let feedback = altered.cycles[place].feedback.as_mut().expect("a reply");
            match encoder {
                true => feedback.motor_counts[motor] ^= 1,
                false => feedback.gauge_counts[motor] ^= 1,
            }
            let first = altered.replay().expect("replayable").first.expect("found");
            assert_eq!(first.index, place, "motor {motor}, encoder {encoder}");
            assert_ne!(first.recorded.command, first.replayed.command, "motor {motor}, encoder {encoder}");
        }
    }

    // The tool finds such an alteration in a file too.
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("finger-2.jsonl");
    let mut altered = recording.clone();
    altered.cycles[place].feedback.as_mut().expect("a reply").gauge_counts[3] ^= 1;
    altered.save(&file).expect("written");
    let (status, reported) = replayed(&file);
    assert_eq!(status, Some(1), "{reported}");
    assert!(reported.contains(&format!("cycle {}, line {}", recording.cycles[place].cycle, place + 2)), "{reported}");
    let (status, reported) = replayed_with(&file, &["--json"]);
    let reported: Value = serde_json::from_str(&reported).unwrap_or_else(|error| panic!("{error}: {reported}"));
    let finger = &reported["fingers"][0];
    assert_eq!((status, &reported["pass"], &finger["finger"]), (Some(1), &json!(false), &json!(2)));
    let first = &finger["first_difference"];
    assert_eq!((&first["cycle"], &first["line"]), (&json!(recording.cycles[place].cycle), &json!(place + 2)));
    assert!(finger["different"].as_u64().is_some_and(|different| different > 0), "{reported:#}");
    assert_eq!(finger["replayed"], json!(recording.cycles.iter().filter(|one| one.control.is_some()).count()));
}

#[test]
fn a_file_comes_back_as_it_was_and_a_damaged_one_is_refused_with_its_reason() {
    let _turn = turn();
    let (board, hand) = own_board(Scheme::StateFeedback, None);
    eventful(&board, &hand);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("finger-2.jsonl");
    hand.write_black_box(2, &file).expect("written");
    let recording = Recording::open(&file).expect("read");
    let again = folder.path().join("again.jsonl");
    recording.save(&again).expect("written");
    let text = fs::read_to_string(&file).expect("text");
    let cycles = |text: &str| text.split_once('\n').expect("a header").1.to_string();
    assert_eq!(cycles(&text), cycles(&fs::read_to_string(&again).expect("text")));
    assert_eq!(Recording::open(&again).expect("read").clock_offset, recording.clock_offset);

    let refusal = |text: &str| {
        fs::write(&file, text).expect("written");
        Recording::open(&file).expect_err("refused")
    };
    let whole: Vec<&str> = text.lines().collect();
    let short = whole[..whole.len() - 1].join("\n");
    assert!(matches!(refusal(&short), RecordingError::Short { .. }));
    let gap = [&whole[..4], &whole[5..]].concat().join("\n");
    assert!(matches!(refusal(&gap), RecordingError::Line { line: 5, .. }));
    let newer = text.replacen("\"sun2xp_black_box\":1", "\"sun2xp_black_box\":2", 1);
    assert!(matches!(refusal(&newer), RecordingError::Version { found: 2, .. }));
    assert!(matches!(refusal("{}\n"), RecordingError::Foreign(..)));
    assert!(matches!(refusal(""), RecordingError::Foreign(..)));
    let (status, reported) = replayed(&file);
    assert!(status == Some(1) && reported.contains("not a black box"), "{reported}");
    assert_eq!(replayed(&folder.path().join("none")).0, Some(1));

    let refused = hand.write_black_box(2, &folder.path().join("none/file")).expect_err("no such folder");
    assert_eq!(refused.errno(), libc::ENOENT, "{refused}");
    let refused = hand.write_black_box(2, Path::new("/dev/null")).expect_err("no regular file");
    assert_eq!(refused.errno(), libc::EINVAL, "{refused}");
    assert_eq!(hand.write_black_box(4, &file).expect_err("no such finger").errno(), libc::EINVAL);
}

#[test]
fn a_folder_that_is_not_there_is_refused_when_the_hand_is_opened() {
    let mut configuration = Configuration::default();
    configuration.hand.black_box = Some("/no/such/folder".into());
    let error = Hand::open(configuration).err().expect("refused");
    assert_eq!(error.errno(), libc::EINVAL);
    assert!(error.to_string().contains("hand.black_box: /no/such/folder is not a folder"), "{error}");
}

/// The record is not from a finger: its numbers are extreme. A file must preserve all numbers exactly.
#[test]
fn numbers_come_back_to_the_last_bit() {
    let third = |sign: f64| sign / 3.0;
    let mut record: CycleRecord<String> = serde_json::from_str(
        r#"{"cycle":1,"began":18446744073709551615,"stage":"running","timing":[1,null,4294967295,0,0,0,0,0],
            "feedback":{"motor_counts":[-2147483648,2147483647,0,-1],"gauge_counts":[0,65535,1,2]},"status":65535,
            "control":null}"#,
    )
    .expect("a record");
    record.began -= 1;
    let text = serde_json::to_string(&record).expect("text");
    assert_eq!(serde_json::from_str::<CycleRecord<String>>(&text).expect("a record"), record);
    for number in [third(1.0), third(-1e-300), f64::MIN_POSITIVE, -0.0, f64::MAX, 5e-324, 0.1 + 0.2] {
        let text = serde_json::to_string(&number).expect("text");
        assert_eq!(serde_json::from_str::<f64>(&text).expect("a number").to_bits(), number.to_bits(), "{text}");
    }
}
