//! Tests `sun2xp replay`: the recomputed cycles equal the recorded ones to the last bit, also after changes, faults and
//! gaps.

#[path = "../common/damage.rs"]
mod damage;
#[allow(dead_code)]
#[path = "../../../tests/common/pauses.rs"]
mod pauses;
mod recorded;
#[allow(dead_code)]
#[path = "../black_box/rig.rs"]
mod rig;

use damage::damaged;
use recorded::{Recorded, recorded};
use rig::replayed_with;
use serde_json::Value;
use sun2xp::finger::CycleRecord;
use sun2xp::model::FingerNumber;
use sun2xp::telemetry::Message;

/// Replays messages through the tool. Returns the exit status and the JSON.
fn replay(recording: &Recorded, messages: &[Message]) -> (Option<i32>, Value) {
    let file = recording.write(messages);
    let (status, reported) = replayed_with(file.path(), &["--json"]);
    (status, serde_json::from_str(&reported).unwrap_or_else(|error| panic!("{error}: {reported}")))
}

fn number_of_cycle(message: &Message, finger: FingerNumber) -> Option<u64> {
    match message {
        Message::Cycle { finger: of, record } if *of == finger => Some(record.cycle),
        _ => None,
    }
}

fn number(value: &Value) -> u64 {
    value.as_u64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn a_run_with_changes_a_fault_and_a_recovery_is_the_same_to_the_last_bit() {
    let recording = recorded();
    let (status, reported) = replay(recording, &recording.messages);
    assert_eq!((status, &reported["pass"]), (Some(0), &Value::Bool(true)), "{reported:#}");
    let fingers = reported["fingers"].as_array().expect("fingers");
    assert_eq!(fingers.len(), 3);
    for (finger, number_of) in fingers.iter().zip(FingerNumber::ALL) {
        let recorded =
            recording.messages.iter().filter(|message| number_of_cycle(message, number_of).is_some()).count();
        assert_eq!(number(&finger["cycles"]), recorded as u64);
        assert!(number(&finger["without_state"]) < 100, "{finger:#}");
        assert!(number(&finger["replayed"]) > 800 && number(&finger["states"]) > 10, "{finger:#}");
        assert_eq!((number(&finger["gaps"]), number(&finger["different_states"])), (0, 0), "{finger:#}");
    }
    let eventful = &fingers[1];
    assert!(number(&eventful["adjustments"]) == 3 && number(&eventful["set_points"]) > 6, "{eventful:#}");
    assert!(number(&eventful["lost_replies"]) > 10 && number(&eventful["restarts"]) >= 1, "{eventful:#}");
    let stages: Vec<&String> = eventful["stages"].as_object().expect("stages").keys().collect();
    assert!(stages.iter().any(|stage| stage.starts_with("faulted")), "{stages:?}");
    assert!(stages.iter().any(|stage| *stage == "opening"), "recovered: {stages:?}");
}

#[test]
fn the_text_names_every_finger() {
    let recording = recorded();
    let file = recording.write(&recording.messages);
    let (status, reported) = replayed_with(file.path(), &[]);
    assert_eq!(status, Some(0), "{reported}");
    for finger in FingerNumber::ALL {
        assert!(reported.contains(&format!("  {finger}, at 500 Hz")), "{reported}");
    }
    assert_eq!(reported.matches("every motor command the same to the last bit").count(), 3, "{reported}");
}

#[test]
fn one_altered_bit_is_found_in_its_cycle() {
    let recording = recorded();
    let mut messages = recording.messages.clone();
    let middle = messages.len() / 2;
    let altered = messages[middle..].iter_mut().find_map(|message| match message {
        Message::Cycle { finger, record } if *finger == FingerNumber::THREE && record.control.is_some() => {
            record.feedback.as_mut().map(|feedback| {
                feedback.gauge_counts[1] ^= 1;
                record.cycle
            })
        }
        _ => None,
    });
    let (status, reported) = replay(recording, &messages);
    assert_eq!((status, &reported["pass"]), (Some(1), &Value::Bool(false)), "{reported:#}");
    let [one, two, three] = [0, 1, 2].map(|finger| &reported["fingers"][finger]);
    assert_eq!(Some(number(&three["first_difference"]["cycle"])), altered, "{three:#}");
    // The next recorded state ends the difference.
    assert!((1..=65).contains(&number(&three["different"])), "{three:#}");
    for same in [one, two] {
        assert_eq!(number(&same["different"]), 0);
    }

    let file = recording.write(&messages);
    let (status, reported) = replayed_with(file.path(), &[]);
    let cycle = altered.expect("a cycle");
    assert!(status == Some(1) && reported.contains(&format!("  cycle {cycle}\n")), "{reported}");
}

#[test]
fn a_gap_is_reported_and_the_replay_continues_after_it() {
    let recording = recorded();
    let begin = recording.messages.iter().filter_map(|message| number_of_cycle(message, FingerNumber::ONE)).nth(300);
    let begin = begin.expect("long enough");
    let lost = begin..begin + 20;
    let whole = recording.messages.iter();
    let rest: Vec<Message> = whole
        .filter(|message| !number_of_cycle(message, FingerNumber::ONE).is_some_and(|cycle| lost.contains(&cycle)))
        .cloned()
        .collect();
    let (status, reported) = replay(recording, &rest);
    assert_eq!(status, Some(0), "{reported:#}");
    let finger = &reported["fingers"][0];
    assert_eq!((number(&finger["gaps"]), number(&finger["missing_cycles"])), (1, 20));
    assert_eq!(number(&finger["first_gaps"][0]["first"]), begin);
    assert!(number(&finger["replayed"]) > 600 && number(&finger["without_state"]) < 200, "{finger:#}");
}

/// The number of the second controller of a finger. In the recorded run, finger 2 is adjusted.
fn second_controller(recording: &Recorded, finger: FingerNumber) -> u32 {
    let mut numbers = recording.messages.iter().filter_map(|message| match message {
        Message::Controller { finger: of, source, .. } if *of == finger => Some(source.number),
        _ => None,
    });
    let first = numbers.next().expect("a controller");
    numbers.find(|number| *number != first).expect("a second controller")
}

#[test]
fn a_lost_controller_leaves_out_its_cycles_only() {
    let recording = recorded();
    let lost = second_controller(recording, FingerNumber::TWO);
    let is_lost = |message: &Message| {
        matches!(message, Message::Controller { finger, source, .. }
            if *finger == FingerNumber::TWO && source.number == lost)
    };
    let rest: Vec<Message> = recording.messages.iter().filter(|message| !is_lost(message)).cloned().collect();
    let (status, reported) = replay(recording, &rest);
    assert_eq!(status, Some(0), "{reported:#}");
    let [one, two, three] = [0, 1, 2].map(|finger| &reported["fingers"][finger]);
    assert!(number(&two["without_controller"]) > 0 && number(&two["replayed"]) > 0, "{two:#}");
    assert_eq!(number(&two["first_without_controller"]["controller"]), u64::from(lost));
    for whole in [one, three] {
        assert_eq!(number(&whole["without_controller"]), 0, "{whole:#}");
        assert!(number(&whole["replayed"]) > 800, "{whole:#}");
    }
    let (_, reported) = replayed_with(recording.write(&rest).path(), &[]);
    assert!(reported.contains(&format!("does not describe controller {lost}: ")), "{reported}");

    let rest = recording.messages.iter().filter(|message| !matches!(message, Message::Controller { .. }));
    let file = recording.write(&rest.cloned().collect::<Vec<_>>());
    let (status, reported) = replayed_with(file.path(), &[]);
    assert!(status == Some(1) && reported.contains("does not describe the controllers of its cycles"), "{reported}");
}

#[test]
fn a_recording_without_states_is_refused() {
    let recording = recorded();
    let rest = recording.messages.iter().filter(|message| !matches!(message, Message::Keyframe { .. }));
    let file = recording.write(&rest.cloned().collect::<Vec<_>>());
    let (status, reported) = replayed_with(file.path(), &[]);
    assert!(status == Some(1) && reported.contains("no recorded state before any of its cycles"), "{reported}");
}

/// Nothing was compared, so nothing may count as equal.
#[test]
fn a_recording_in_which_no_controller_runs_is_refused() {
    let recording = recorded();
    let cycles = recording.messages.iter().filter_map(|message| match message {
        Message::Cycle { finger, record } => {
            Some(Message::Cycle { finger: *finger, record: CycleRecord { control: None, ..*record } })
        }
        _ => None,
    });
    let file = recording.write(&cycles.collect::<Vec<_>>());
    let (status, reported) = replayed_with(file.path(), &[]);
    assert!(status == Some(1) && reported.contains("no cycles in which a controller has run"), "{reported}");
}

#[test]
fn a_recording_without_an_end_is_replayed_and_a_damaged_one_is_refused() {
    let recording = recorded();
    let file = recording.write(&recording.messages);
    let whole = std::fs::read(file.path()).expect("read");
    let part = &whole[..whole.len() * 2 / 3];
    std::fs::write(file.path(), part).expect("written");
    let (status, reported) = replayed_with(file.path(), &[]);
    assert!(status == Some(0) && reported.contains("has no end"), "{reported}");

    // The checksum of the chunk detects one altered bit, and the message names the last good cycle.
    std::fs::write(file.path(), damaged(&whole)).expect("written");
    let (status, reported) = replayed_with(file.path(), &[]);
    assert!(status == Some(1) && reported.lines().count() == 1, "{reported}");
    for part in ["The file was altered or damaged", "copy it again", "The last cycle that was read is cycle "] {
        assert!(reported.contains(part), "{reported}");
    }
    let (status, reported) = replayed_with(recording.write(&[]).path(), &[]);
    assert!(status == Some(1) && reported.contains("no cycles"), "{reported}");
    std::fs::write(file.path(), &whole[..8]).expect("written");
    let (status, reported) = replayed_with(file.path(), &[]);
    assert!(
        status == Some(1) && reported.contains("is not a recording") && reported.contains("copy it again"),
        "{reported}"
    );
}
